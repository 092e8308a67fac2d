# Every command a person needs. The first one that needs Python makes .venv from the hash-locked requirements.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

# Paths stay relative, so that the checkout may have a space in its own.
SUITABLE := import ensurepip, sys, venv; sys.exit(not (3, 11) <= sys.version_info < (3, 14))
PYTHON ?= $(shell for name in python3.11 python3.12 python3.13 python3; do \
	if $$name -c '$(SUITABLE)' 2> /dev/null; then echo $$name; break; fi; done)
RUN := .venv/bin/python
READY := .venv/.ready
LOCK := docker/requirements-dev.txt
LOCK_FLAGS := --universal --generate-hashes --extra postgres --extra ros \
	--no-emit-index-url --no-emit-find-links --no-annotate --no-header

# Matrices are small and many: threads inside the linear algebra only get in each other's way.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
export MKL_NUM_THREADS := 1
# Where bytecode is switched off, each of the many processes that tests start would compile every module again.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: help setup demo serve test check style types imports drift containers answers hidden battery ablate hostile fuzz spoilt ranks conflicts truths audit contract chaos life image-test bench lock openapi reference docs

help: ## list the commands
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "make %-12s %s\n", $$1, $$2}' Makefile

setup: $(READY) ## make .venv from the hash-locked requirements

$(READY): $(LOCK)
	@if [ ! -x $(RUN) ]; then python="$(PYTHON)"; \
		if [ -z "$$python" ] || ! "$$python" -c '$(SUITABLE)' 2> /dev/null; then \
			echo "Veritorque needs Python 3.11, 3.12 or 3.13 with its venv module; $${python:-what is on the path} does not do." >&2; \
			echo "Install one (on Debian and Ubuntu with python3-venv), or name one: make setup PYTHON=python3.12" >&2; exit 1; fi; \
		echo "Making .venv with $$python; this takes a minute or two."; \
		"$$python" -m venv .venv; fi
	$(RUN) -m pip install --quiet --disable-pip-version-check --no-input --no-compile --require-hashes -r $(LOCK)
	@touch $(READY)

demo: $(READY) ## identify a YuMi arm through the service, then diagnose a log in which something is hidden
	$(RUN) -m examples.yumi.demo

serve: $(READY) ## start the service on loopback and print its URL
	$(RUN) -m veritorque serve

# A third of what tests take is waiting for services and browsers; to collect them on a third worker costs more.
test: $(READY) ## run every test (WORKERS=n at the same time, 2 by default)
	$(RUN) -m pytest -n $(or $(WORKERS),2) $(ARGS)

check: style types imports drift containers docs ## style, types, import contracts, API document, container files, site

style: $(READY)
	$(RUN) -m ruff check .
	$(RUN) -m ruff format --check .

types: $(READY)
	$(RUN) -m mypy --package veritorque

imports: $(READY)
	.venv/bin/lint-imports --no-logo

drift: $(READY)
	$(RUN) -m veritorque openapi | diff openapi.json - || { echo "openapi.json is not what the service gives: make openapi" >&2; exit 1; }

containers: $(READY)
	.venv/bin/hadolint docker/Dockerfile
	.venv/bin/check-jsonschema --builtin-schema vendor.compose-spec docker/compose.yaml
	.venv/bin/check-jsonschema --builtin-schema vendor.github-workflows .github/workflows/ci.yml
	.venv/bin/check-jsonschema --builtin-schema vendor.citation-file-format CITATION.cff

answers: $(READY) ## keep what the product answers before a change, or compare after it (DO=record|compare KEPT=dir ARGS=..)
	$(RUN) -m tests.answers $(or $(DO),compare) $(if $(KEPT),--kept $(KEPT)) $(ARGS)

hidden: $(READY) ## hide effects in a simulated robot and score the diagnosis, then diagnose what was answered wrongly once (SEED=n CASES=m STRENGTH=.. CAUSE=.. KIND=..)
	$(RUN) -m tests.hidden --seed $(or $(SEED),1) --cases $(or $(CASES),60) \
		$(if $(STRENGTH),--strength $(STRENGTH)) $(if $(CAUSE),--cause $(CAUSE)) $(if $(KIND),--kind $(KIND))
	$(RUN) -m tests.hidden regressions

battery: $(READY) ## the whole examination of the diagnosis: every cause 20 times, 300 clean logs (SEED=n; hours)
	$(RUN) -m tests.hidden --seed $(or $(SEED),1) --battery

ablate: $(READY) ## halve and double every threshold of the diagnosis and list those that change no answer (SEED=n CASES=m ONLY=GROUP.FIELD COUNT=1)
	$(RUN) -m tests.hidden ablate --seed $(or $(SEED),1) $(if $(CASES),--cases $(CASES)) $(if $(ONLY),--only $(ONLY)) $(if $(COUNT),--count)

hostile: $(READY) ## send every hostile file to the service and print how each was treated
	$(RUN) -m tests.hostile

fuzz: $(READY) ## read files spoilt at random, in every format (RUNS=n SEED=s)
	$(RUN) -m tests.fuzz --runs $(or $(RUNS),20000) --seed $(or $(SEED),1)

spoilt: $(READY) ## spoil the values of sound logs in many ways (SEED decides), and count the false causes (RUNS=n)
	$(RUN) -m tests.spoilt --runs $(or $(RUNS),200) --seed $(or $(SEED),1)

ranks: $(READY) ## compare base parameters with the rank of pinocchio's regressor on drawn URDFs (ROBOTS=n SEED=s)
	$(RUN) -m tests.ranks --robots $(or $(ROBOTS),250) --seed $(or $(SEED),1)

conflicts: $(READY) ## spoil one thing in sound robots and logs (SEED decides), and count what is named
	$(RUN) -m tests.conflicts --seed $(or $(SEED),1) $(ARGS)

truths: $(READY) ## change one thing in measured logs (SEED decides, ONLY=text picks), and count what is named
	$(RUN) -m tests.truths --seed $(or $(SEED),1) --only "$(ONLY)"

audit: $(READY) ## spoil bodies in descriptions of drawn arms (SEED decides), and count what an audit names
	$(RUN) -m tests.audit --seed $(or $(SEED),1) $(ARGS)

contract: $(READY) ## ask the service all that its contract allows and forbids (CASES=n SEED=m)
	$(RUN) -m tests.contract --cases $(or $(CASES),5000) --seed $(or $(SEED),1)

bench: $(READY) ## measure speed and accuracy
	$(RUN) -m benchmarks $(ARGS)

chaos: $(READY) ## kill and freeze the service 360 times over 1,000 jobs, on SQLite and on PostgreSQL (JOBS=n KILLS=n FREEZES=n)
	$(RUN) -m tests.chaos --jobs $(or $(JOBS),1000) --kills $(or $(KILLS),300) --freezes $(or $(FREEZES),60) \
		$(if $(DATABASE),--database $(DATABASE))

life: $(READY) ## lead jobs through every turn of their life, and two tenants past each other (RUNS=n OPERATIONS=n)
	$(RUN) -m tests.life --runs $(or $(RUNS),2000) --operations $(or $(OPERATIONS),10000)

image-test: ## build the image without a daemon and run the service in it (needs root and buildah)
	docker/image-test

lock: ## rewrite the locked requirements after a change of dependencies (needs uv)
	uv pip compile $(LOCK_FLAGS) pyproject.toml --output-file docker/requirements.txt
	uv pip compile $(LOCK_FLAGS) --extra test pyproject.toml --output-file $(LOCK)

openapi: $(READY) ## rewrite openapi.json after a change of the API
	$(RUN) -m veritorque openapi > openapi.json.new
	mv openapi.json.new openapi.json

reference: $(READY) ## rewrite the generated pages of docs/ after a change of the API, causes, terms, formats or problems
	$(RUN) -m veritorque.app.reference.api < openapi.json > docs/api.md.new
	$(RUN) -m veritorque.app.reference.problems > docs/problems.md.new
	$(RUN) -m veritorque.core.dynamics.guide > docs/terms.md.new
	$(RUN) -m veritorque.core.export.guide > docs/formats.md.new
	$(RUN) -m veritorque.core.diagnosis.causes.guide > docs/causes.md.new
	for page in api problems terms formats causes; do mv docs/$$page.md.new docs/$$page.md; done

docs: $(READY) ## build the pages of docs/ as a site in site/, which opens without a server
	$(RUN) -m sphinx --fresh-env --write-all --fail-on-warning --keep-going --nitpicky --quiet -d .sphinx docs site
	@echo "site/index.html"

// Choose a robot: one that is known, one described by its table, or one from a URDF. Whatever is chosen is drawn.
import { get, post, request } from "../base/api.js";
import { auditOf } from "../result/audit.js";
import { drawChain } from "../drawing/chain.js";
import { dropZone, field, menu, readNumber, segments } from "../base/controls.js";
import { couplingForm, couplingWords } from "./couplings.js";
import { element, fill } from "../base/dom.js";
import { showError } from "../base/problem.js";
import { robotTable } from "./table.js";
import { ago, number, plural, short } from "../base/words.js";

const WAYS = { list: "From the list", table: "DH table", urdf: "URDF" };

/**
 * Offer the ways to a robot.
 * @param {HTMLElement} container
 * @param {Object} options `wanted`: the id of a robot to begin with; `chosen(robot)` called at every choice, null for none
 */
export function chooseRobot(container, { wanted, chosen }) {
  const form = element("div", { class: "stack" });
  const said = element("div", { class: "said", "aria-live": "polite" });
  const figure = element("div", { class: "figure" });
  const layout = element("div", { class: "split" }, element("div", { class: "stack" }, form, said), figure);
  fill(container, segments("Source of the robot", WAYS, "list", turn), layout);
  let drawn = null;
  let now = "list";
  turn("list");

  async function turn(way) {
    now = way;
    fill(said);
    layout.classList.toggle("stacked", way === "table");
    if (way === "urdf") {
      use(null);
      showUrdf();
      return;
    }
    try {
      const { robots } = await get("/v1/robots?limit=1000");
      if (now === way) ({ list: showList, table: showTable })[way](robots);
    } catch (error) {
      showError(said, error);
    }
  }

  function showList(robots) {
    const entries = robots.map((one) => [one.id, `${one.name} (${plural("joint", one.joints)}), ${origin(one)}`]);
    const first = robots.some((one) => one.id === wanted) ? wanted : "";
    const list = menu([["", "Choose a robot"], ...entries], first, read);
    fill(form, field("Robot", list, "Built-in robots first, then uploaded ones."));
    read(first);
    if (wanted && !first)
      fill(said, element("p", { class: "notice" }, `There is no robot ${wanted}: choose another one.`));
  }

  async function read(id) {
    if (!id) {
      use(null);
      return;
    }
    try {
      use(await get(`/v1/robots/${encodeURIComponent(id)}`));
    } catch (error) {
      use(null);
      showError(said, error);
    }
  }

  function showTable(robots) {
    use(null);
    robotTable(form, {
      known: robots,
      changed: edited,
      finished: async (description, refused) => {
        try {
          use(await post("/v1/robots", description));
        } catch (error) {
          refused(error?.problem?.evidence?.pointer ?? "");
          showError(said, error);
        }
      },
    });
  }

  // What was taken is not what the table says any more.
  function edited(description) {
    fill(said);
    chosen(null);
    if (description !== null) draw(description);
  }

  function showUrdf() {
    const texts = {
      base_link: element("input", { type: "text", spellcheck: "false" }),
      tip_link: element("input", { type: "text", spellcheck: "false" }),
      gravity: element("input", { type: "text", placeholder: "0, 0, -9.81" }),
    };
    fill(
      form,
      dropZone(
        "Drop a URDF here",
        "or choose a file. Its masses and inertias become the prior.",
        ".urdf,.xml",
        take,
      ),
      element(
        "details",
        {},
        element("summary", {}, "Part of the robot, or another mounting"),
        element(
          "div",
          { class: "fields" },
          field("From link", texts.base_link, "default: the root"),
          field("To link", texts.tip_link, "default: every moving link; several: a, b"),
          field("Gravity, m/s²", texts.gravity, "x, y, z in the base frame"),
        ),
      ),
    );

    async function take(file) {
      const query = new URLSearchParams(
        Object.entries(texts)
          .map(([name, input]) => [name, input.value.trim()])
          .filter(([, value]) => value),
      );
      if (query.has("gravity"))
        query.set(
          "gravity",
          query
            .get("gravity")
            .split(/[,;\s]+/)
            .map(readNumber)
            .join(","),
        );
      try {
        const response = await request(`/v1/robots?${query}`, {
          method: "POST",
          body: file,
          headers: { "Content-Type": "application/xml" },
        });
        use(await response.json());
      } catch (error) {
        use(null);
        showError(said, error);
      }
    }
  }

  function use(robot) {
    fill(said, robot === null ? null : [
      summary(robot),
      robot.description.prior ? auditOf(robot) : null,
      now === "table" ? null : coupled(robot),
    ]);
    draw(robot?.description ?? null);
    chosen(robot);
  }

  // The table has this form itself; a robot from elsewhere is copied with the motors that are typed.
  function coupled(robot) {
    const { couplings, joints } = robot.description;
    const wrong = element("p", { class: "hint wrong", role: "status" });
    const motors = couplingForm(couplings ?? [], () => fill(wrong));
    const take = element("button", { type: "button", class: "primary", on: { click: copy } }, "Use a copy with these motors");
    return element(
      "details",
      { class: "coupled" },
      element("summary", {}, couplings?.length ? "Change the coupled motors" : "Add coupled motors"),
      motors.node,
      element("div", { class: "actions" }, take, wrong),
    );

    async function copy() {
      const typed = motors.read(joints.filter((joint) => !joint.mimics).length);
      if (typed.fault) {
        fill(wrong, typed.fault);
        return;
      }
      try {
        use(await post("/v1/robots", { ...robot.description, couplings: typed.couplings }));
      } catch (error) {
        showError(wrong, error);
      }
    }
  }

  function draw(description) {
    if (description === null || !description.joints.length) {
      fill(figure);
      drawn = null;
    } else if (drawn === null) {
      drawn = drawChain(figure, description);
    } else {
      drawn.update(description);
    }
  }
}

/** Where a robot comes from, which tells it from another of its name. */
function origin(robot) {
  return robot.built_in ? "built in" : `created ${ago(robot.created_at)}, ${short(robot.id)}`;
}

/** The rows of a robot as they are read, in degrees and metres; what is given by frames has no row. */
function rowsOf(description) {
  const tabular = description.convention === "modified-dh";
  const degrees = (angle) => number((angle * 180) / Math.PI, 4);
  const range = (joint) => {
    const limits = joint.limits?.position;
    if (!limits) return "–";
    return joint.type === "revolute"
      ? `${degrees(limits[0])} … ${degrees(limits[1])}°`
      : `${number(limits[0])} … ${number(limits[1])} m`;
  };
  const heads = ["joint", ...(tabular ? ["α, °", "d, m", "θ, °", "r, m"] : ["type"]), "range"];
  return element(
    "div",
    { class: "wide", tabindex: "0", role: "group", "aria-label": "Joints of the robot" },
    element(
      "table",
      { class: "rows" },
      element(
        "thead",
        {},
        element(
          "tr",
          {},
          heads.map((name) => element("th", { scope: "col" }, name)),
        ),
      ),
      element(
        "tbody",
        {},
        description.joints.map((joint, index) =>
          element(
            "tr",
            {},
            element("th", { scope: "row" }, joint.name ?? `joint_${index + 1}`),
            (tabular
              ? [degrees(joint.alpha), number(joint.d), degrees(joint.theta_offset), number(joint.r)]
              : [joint.type]
            ).map((value) => element("td", {}, value)),
            element("td", {}, range(joint)),
          ),
        ),
      ),
    ),
  );
}

function summary(robot) {
  const { description } = robot;
  const prismatic = description.joints.filter((joint) => joint.type === "prismatic").length;
  const facts = [
    plural("joint", robot.joints) + (prismatic ? `, ${prismatic} prismatic` : ""),
    description.convention === "modified-dh" ? "modified Denavit-Hartenberg table" : "frames",
    `gravity ${description.gravity.map((value) => number(value, 3)).join(", ")} m/s²`,
    description.prior ? "with prior" : null,
    ...couplingWords(description.couplings ?? []),
  ];
  return element(
    "div",
    {},
    element("p", { class: "chosen" }, element("strong", {}, robot.name), ` · ${facts.filter(Boolean).join(" · ")}`),
    rowsOf(description),
    robot.suspicions.length
      ? element(
          "div",
          { class: "notice" },
          element("strong", {}, "Check"),
          element(
            "ul",
            {},
            robot.suspicions.map((one) => element("li", {}, one)),
          ),
        )
      : null,
  );
}

"""Hold the page's one style sheet: light, dark and paper, without a font or a picture from elsewhere."""

STYLE = """
:root { color-scheme: light dark; --ink: #1c2430; --soft: #5a6675; --paper: #fff; --card: #f6f8fa;
  --line: #d5dbe3; --bad: #b3261e; --good: #1a7f45; --model: #c2410c; --one: #0a5ea8; --two: #7c3aed; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e9f0; --soft: #9aa7b8; --paper: #14181f;
  --card: #1b212b; --line: #364152; --bad: #ff8a80; --good: #6fd39a; --model: #ffa56b; --one: #7ab8f5;
  --two: #c4a5ff; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 62rem; margin: 0 auto; padding: 1.75rem 1.25rem 4rem; }
h1 { margin: 0 0 .25rem; font-size: 1.05rem; font-weight: 600; color: var(--soft); }
.verdict { margin: 0 0 1rem; font-size: 1.5rem; line-height: 1.3; font-weight: 650; }
h2 { margin: 2.5rem 0 .6rem; font-size: 1.25rem; }
h3 { margin: 0 0 .5rem; font-size: 1.1rem; }
h4 { margin: 1.25rem 0 .3rem; font-size: .95rem; }
p, ul, ol { margin: .4rem 0; }
ul, ol { padding-left: 1.25rem; }
.note, .meta { color: var(--soft); font-size: .88rem; }
.finding { margin: 1.25rem 0; padding: 1rem 1.25rem 1.25rem; border: 1px solid var(--line);
  border-left: 5px solid var(--model); border-radius: 6px; background: var(--card); }
.statement { font-size: 1.08rem; }
.key { display: grid; grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr)); gap: .75rem;
  margin: .9rem 0; }
.key div { border-top: 2px solid var(--line); padding-top: .35rem; }
.key b { display: block; font-size: 1.3rem; line-height: 1.25; }
.key span { color: var(--soft); font-size: .85rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: .6rem 0; font-size: .9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding-bottom: .3rem; }
th, td { padding: .25rem .9rem .25rem 0; border-bottom: 1px solid var(--line); text-align: right;
  vertical-align: top; }
th:first-child, .text { text-align: left; }
thead th { color: var(--soft); font-weight: 600; }
tbody th { font-weight: 500; }
td:not(.text) { white-space: nowrap; }
.better { color: var(--good); font-weight: 600; }
.worse { color: var(--bad); font-weight: 600; }
figure { margin: .9rem 0; }
figcaption { color: var(--soft); font-size: .88rem; }
.pair { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(21rem, 100%), 1fr));
  gap: .5rem 1rem; }
.bars svg { max-width: 36rem; }
.bars figcaption { margin-bottom: .4rem; font-weight: 600; color: var(--ink); }
svg { display: block; width: 100%; height: auto; }
svg text { fill: var(--soft); font-size: 12px; font-family: inherit; }
svg text.title { fill: var(--ink); font-weight: 600; font-size: 13px; }
.grid { stroke: var(--line); stroke-width: 1; }
.line { fill: none; stroke-width: 2; }
.line.model { stroke: var(--model); }
.line.zero { stroke: var(--ink); stroke-width: 1; }
.line.floor { stroke: var(--soft); stroke-width: 1.5; stroke-dasharray: 5 4; }
.line.both { stroke: var(--one); stroke-width: 1.5; }
.band { fill: var(--model); opacity: .2; }
.band.floor { fill: var(--soft); opacity: .22; }
.dot.both, .dot.forward { fill: var(--one); }
.dot.backward { fill: var(--paper); stroke: var(--two); stroke-width: 1.8; }
.bar.before { fill: var(--model); opacity: .45; }
.bar.after { fill: var(--one); }
code { overflow-wrap: anywhere; }
@media (max-width: 40rem) {
  main { padding: 1.25rem .9rem 3rem; }
  .verdict { font-size: 1.25rem; }
  .finding { padding: .75rem .8rem 1rem; }
  .key { grid-template-columns: repeat(2, 1fr); }
  .pair svg text { font-size: 15px; }
  .pair svg text.title { font-size: 16px; }
}
@media print {
  :root { color-scheme: light; --ink: #000; --soft: #444; --paper: #fff; --card: #fff; --line: #bbb;
    --model: #c2410c; --one: #0a5ea8; --two: #7c3aed; --bad: #b3261e; --good: #1a7f45; }
  body { font-size: 10.5pt; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  main { max-width: none; padding: 0; }
  table { font-size: 8pt; }
  th, td { padding-right: .6rem; }
  .key { grid-template-columns: repeat(4, 1fr); }
  .pair { grid-template-columns: repeat(2, 1fr); }
  figure, tr, .key { break-inside: avoid; }
  h2, h3, h4 { break-after: avoid; }
  .wide { overflow: visible; }
}
"""

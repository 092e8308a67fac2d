"""Hold the page's one style sheet: light, dark and paper, without a font or a picture from elsewhere."""

STYLE = """
:root { color-scheme: light dark; --ink: #1c2430; --soft: #5a6675; --paper: #fff; --card: #f6f8fa;
  --line: #d5dbe3; --bad: #b3261e; --good: #1a7f45; --model: #c2410c; --one: #0a5ea8; --two: #7c3aed;
  --faint: #a9b4c2; --j1: #0a5ea8; --j2: #c2410c; --j3: #1a7f45; --j4: #7c3aed; --j5: #b3261e;
  --j6: #0e7490; --j7: #a16207; --j8: #4b5563; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e9f0; --soft: #9aa7b8; --paper: #14181f;
  --card: #1b212b; --line: #364152; --bad: #ff8a80; --good: #6fd39a; --model: #ffa56b; --one: #7ab8f5;
  --two: #c4a5ff; --faint: #66748a; --j1: #7ab8f5; --j2: #ffa56b; --j3: #6fd39a; --j4: #c4a5ff;
  --j5: #ff8a80; --j6: #67d3e4; --j7: #e3c15b; --j8: #b6c0cd; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.5 system-ui, sans-serif;
  overflow-wrap: break-word; }
main { max-width: 62rem; margin: 0 auto; padding: 1.75rem 1.25rem 4rem; }
.kind { margin: 0 0 .25rem; font-weight: 600; color: var(--soft); }
.verdict { margin: 0 0 1rem; font-size: 1.5rem; line-height: 1.3; font-weight: 650; }
.facts { display: flex; flex-wrap: wrap; gap: .3rem 1.5rem; margin: 1.1rem 0 0; padding: .6rem 0;
  border-top: 1px solid var(--line); border-bottom: 1px solid var(--line); font-size: .85rem; }
.facts dt { color: var(--soft); }
.facts dd { margin: 0; overflow-wrap: anywhere; }
footer { max-width: 62rem; margin: 0 auto; padding: 0 1.25rem 2rem; color: var(--soft); font-size: .85rem; }
h2 { margin: 2.5rem 0 .6rem; font-size: 1.25rem; }
h3 { margin: 1.5rem 0 .5rem; font-size: 1.1rem; }
.finding h3 { margin-top: 0; }
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
td.text { min-width: 11rem; }
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
.whisker { width: 7.5rem; display: inline-block; vertical-align: middle; }
.whisker .bar.thick { stroke: var(--one); stroke-width: 3.5; }
.whisker .bar.thin { stroke: var(--soft); stroke-width: 1.2; }
.grid { stroke: var(--line); stroke-width: 1; }
.line { fill: none; stroke-width: 2; }
.line.model { stroke: var(--model); }
.line.zero { stroke: var(--ink); stroke-width: 1; }
.line.floor { stroke: var(--soft); stroke-width: 1.5; stroke-dasharray: 5 4; }
.line.both { stroke: var(--one); stroke-width: 1.5; }
.line.trace { stroke-width: 1.1; stroke-linejoin: round; }
.line.measured { stroke: var(--faint); stroke-width: .9; }
.line.filtered { stroke: var(--one); stroke-width: 3.5; opacity: .45; }
.line.estimated { stroke: var(--model); stroke-width: 1.1; }
.line.residual { stroke: var(--two); stroke-width: .9; }
.band.unseen { fill: var(--soft); opacity: .13; }
.j1 { stroke: var(--j1); } .j2 { stroke: var(--j2); } .j3 { stroke: var(--j3); } .j4 { stroke: var(--j4); }
.j5 { stroke: var(--j5); } .j6 { stroke: var(--j6); } .j7 { stroke: var(--j7); } .j8 { stroke: var(--j8); }
.legend span { display: inline-block; margin-right: 1.1rem; }
.swatch { display: inline-block; width: 1.3rem; height: 0; border-top: 3px solid; vertical-align: middle; }
.swatch.measured { border-color: var(--faint); }
.swatch.filtered { border-top-width: 5px; border-color: var(--one); opacity: .45; }
.swatch.estimated { border-color: var(--model); } .swatch.residual { border-color: var(--two); }
.swatch.unseen { height: .8rem; border: 0; background: var(--soft); opacity: .25; }
.swatch.j1 { border-color: var(--j1); } .swatch.j2 { border-color: var(--j2); }
.swatch.j3 { border-color: var(--j3); } .swatch.j4 { border-color: var(--j4); }
.swatch.j5 { border-color: var(--j5); } .swatch.j6 { border-color: var(--j6); }
.swatch.j7 { border-color: var(--j7); } .swatch.j8 { border-color: var(--j8); }
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
  .long td.text { min-width: 24rem; }
  .traces { overflow-x: auto; }
  .traces svg { min-width: 44rem; }
  .traces figcaption { position: sticky; left: 0; }
  .pair svg text { font-size: 15px; }
  .pair svg text.title { font-size: 16px; }
}
@media print {
  :root { color-scheme: light; --ink: #000; --soft: #444; --paper: #fff; --card: #fff; --line: #bbb;
    --model: #c2410c; --one: #0a5ea8; --two: #7c3aed; --bad: #b3261e; --good: #1a7f45; --faint: #9aa5b3;
    --j1: #0a5ea8; --j2: #c2410c; --j3: #1a7f45; --j4: #7c3aed; --j5: #b3261e; --j6: #0e7490;
    --j7: #a16207; --j8: #4b5563; }
  body { font-size: 9.5pt; line-height: 1.4; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  main { max-width: none; padding: 0; }
  .verdict { font-size: 16pt; }
  h2 { margin-top: 1.6rem; font-size: 13pt; }
  h3 { font-size: 11pt; }
  .statement { font-size: 10.5pt; }
  table { font-size: 7.5pt; }
  .note, .meta, figcaption { font-size: 7.5pt; }
  th, td { padding: .14rem .6rem .14rem 0; }
  .key { grid-template-columns: repeat(4, 1fr); }
  .key b { font-size: 12pt; }
  .key span { font-size: 8pt; }
  .pair { grid-template-columns: repeat(2, 1fr); }
  .finding { padding: .6rem .9rem .7rem; box-decoration-break: clone; -webkit-box-decoration-break: clone; }
  .facts { gap: .3rem 1.1rem; font-size: 8pt; }
  .bars svg { max-width: 26rem; }
  .whisker { width: 5rem; }
  figure { margin: .4rem 0; }
  figure, tr, .key, .facts, .wide:not(.long), li { break-inside: avoid; }
  h1, h2, h3, h4, caption, .statement { break-after: avoid; }
  .note { break-before: avoid; }
  p { orphans: 3; widows: 3; }
  .wide { overflow: visible; }
  footer { padding: 1rem 0 0; }
}
@page { size: A4; margin: 17mm 15mm 16mm; }
@page { @top-left { font: 8pt system-ui, sans-serif; color: #444; }
  @top-right { font: 8pt system-ui, sans-serif; color: #444; }
  @bottom-left { font: 8pt system-ui, sans-serif; color: #444; }
  @bottom-right { font: 8pt system-ui, sans-serif; color: #444; } }
"""

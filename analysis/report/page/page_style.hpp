/// \file The style sheet of report pages. Private to analysis/report/page.
#pragma once

namespace touchtrial::analysis {

/// Colours have a contrast of at least 4.5 to their background, in the light and in the dark
/// scheme. Figures keep a white background because they are drawn for paper.
inline constexpr const char* kPageStyle = R"(
:root {
  color-scheme: light dark;
  --ink: #1b1b1b; --soft: #555; --ground: #fff; --panel: #f6f6f4; --line: #d4d4d0; --rule: #1b1b1b;
  --link: #0b4f8a; --warn-ink: #5c3b00; --warn-ground: #fff6e0; --warn-line: #b47a00;
  --stamp-ink: #8a1c14; --stamp-ground: #fdf0ef; --stamp-line: #b3261e; --strong: #e3eef8;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ink: #e8e8e6; --soft: #b3b3b0; --ground: #16181a; --panel: #202325; --line: #3c4043;
    --rule: #c8c8c6; --link: #8cc4f5; --warn-ink: #f5dca8; --warn-ground: #2e2614;
    --warn-line: #c99a3a; --stamp-ink: #ffb4ab; --stamp-ground: #341a18; --stamp-line: #e4695f;
    --strong: #22384c;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body { font: 16px/1.55 system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif;
       color: var(--ink); background: var(--ground); margin: 0; }
header, main, footer { max-width: 62rem; margin: 0 auto; padding: 0 1.25rem; }
header { padding-top: 1rem; }
h1 { font-size: 1.6rem; line-height: 1.2; margin: 0 0 .6rem; overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; line-height: 1.25; margin: 2.2rem 0 .8rem; padding-top: .5rem;
     border-top: 2px solid var(--rule); overflow-wrap: anywhere; }
main > section:first-child > h2 { margin-top: 0; padding-top: .4rem; margin-bottom: .5rem; }
h3 { font-size: 1.05rem; margin: 1.4rem 0 .5rem; overflow-wrap: anywhere; }
p { margin: 0 0 .8rem; max-width: 46rem; overflow-wrap: anywhere; }
a { color: var(--link); }
a:focus-visible, summary:focus-visible, .scroll:focus-visible { outline: 3px solid var(--link);
  outline-offset: 2px; }
.lead { max-width: none; }
.banner { border-left: 6px solid var(--stamp-line); background: var(--stamp-ground);
          color: var(--stamp-ink); padding: .4rem 1rem; margin: 0 0 .6rem; font-weight: 600;
          font-size: .95rem; line-height: 1.4; max-width: none; }
.banner + .banner { margin-top: -.6rem; padding-top: 0; }
.warnings { border-left: 6px solid var(--warn-line); background: var(--warn-ground);
            color: var(--warn-ink); padding: .5rem 1rem; margin: 0 0 1rem; font-size: .95rem;
            line-height: 1.4; }
.warnings p { margin: 0; font-weight: 600; }
.warnings ul { margin: 0; padding: 0 0 0 1.2rem; }
.warnings li { margin: .25rem 0; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: minmax(8rem, max-content) 1fr; gap: .25rem 1.25rem;
     margin: 0 0 1.2rem; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
nav { margin-top: 2rem; }
nav h2 { font-size: 1rem; margin: 0 0 .3rem; padding: 0; border: 0; }
nav ul { margin: 0; padding: 0; list-style: none; display: flex; flex-wrap: wrap;
         gap: .15rem 1.4rem; }
.table { margin: 1.2rem 0 1.8rem; }
main > section:first-child .table { margin: .8rem 0; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .9rem;
        border-bottom: 1.5px solid var(--rule); }
caption { text-align: left; padding: 0 0 .5rem; font-size: 1rem; }
/* Wider than a narrow table, without making it wider: the margin takes the width back. */
caption span { display: block; position: sticky; left: 0; width: max-content;
               max-width: min(46rem, calc(100vw - 2.5rem)); margin-right: -46rem; }
caption b, figcaption b { font-weight: 600; }
thead th { border-top: 1.5px solid var(--rule); border-bottom: 1px solid var(--rule);
           vertical-align: bottom; font-weight: 600; }
th, td { padding: .3rem .75rem; text-align: right; white-space: nowrap; }
thead th { white-space: normal; }
th:first-child, td:first-child { padding-left: .25rem; }
th:last-child, td:last-child { padding-right: .25rem; }
th.l, td.l { text-align: left; }
td.l, tbody th { white-space: normal; overflow-wrap: break-word; min-width: 7ch; max-width: 34rem; }
td.wide { min-width: 24ch; }
td, tbody th { vertical-align: top; }
tbody th { font-weight: 400; text-align: left; }
tbody tr:nth-child(even) { background: var(--panel); }
tbody tr td.s { background: var(--strong); font-weight: 600; }
.notes { font-size: .85rem; color: var(--soft); margin-top: .5rem; }
.notes p { margin: 0 0 .25rem; }
main > section:first-child .notes p { max-width: none; }
details { margin: 1rem 0; }
summary { cursor: pointer; padding: .25rem 0; }
details.more > summary { color: var(--link); font-weight: 600; }
details.more[open] { border-left: 3px solid var(--line); padding-left: 1rem; }
.whole-more details { margin: .2rem 0; }
.whole-more h3 { display: inline; margin: 0; font-size: 1rem; }
figure { margin: 1.6rem 0 2rem; }
figcaption { margin-top: .5rem; max-width: 46rem; overflow-wrap: anywhere; }
figure details { margin: .3rem 0 0; font-size: .9rem; }
.plot { background: #fff; padding: .4rem; border: 1px solid var(--line); max-width: 100%;
        width: calc(var(--cm) * 2.9rem); }
.plot svg { display: block; width: 100%; height: auto; max-width: 100%; }
.flow ol { list-style: none; margin: 0; padding: 0; max-width: 34rem; }
.flow ol > li { position: relative; padding-bottom: 1.6rem; }
.flow ol > li:last-child { padding-bottom: 0; }
.flow ol > li:not(:last-child)::after { content: "↓" / ""; position: absolute; bottom: .05rem;
  left: 2rem; line-height: 1.5; color: var(--soft); }
.box { border: 1.5px solid var(--rule); padding: .4rem .8rem; overflow-wrap: anywhere; }
.leaving { margin: .6rem 0 0 3.4rem; padding: .3rem .8rem .3rem 1.8rem; border: 1px dashed var(--soft);
           font-size: .9rem; overflow-wrap: anywhere; }
.references li { margin: .35rem 0; max-width: 46rem; overflow-wrap: anywhere; }
footer { border-top: 1px solid var(--line); margin-top: 3rem; padding-top: .8rem;
         padding-bottom: 2rem; color: var(--soft); font-size: .85rem; overflow-wrap: anywhere; }
@media (max-width: 40rem) {
  h1 { font-size: 1.5rem; }
  header, main, footer { padding-left: 1rem; padding-right: 1rem; }
  .plot { border: 0; padding: 0; }
  .plot svg g[font-size] { font-size: 12.5px; }
  dl { display: block; }
  dd { margin: 0 0 .5rem; }
  table { font-size: .82rem; }
  th, td { padding: .25rem .35rem; }
  td.l, tbody th { min-width: 4ch; }
  td.wide { min-width: 12ch; }
}
@media (max-width: 28rem) {
  table { font-size: .76rem; }
  th, td { padding: .25rem .22rem; }
}
@media screen and (min-width: 62rem) {
  main > section:first-child, main > section:first-child > .warnings { display: flow-root; }
  main > section:first-child > figure { float: left; clear: left; width: 38rem;
    margin: .2rem 1.5rem .6rem 0; }
  main > section:first-child > :is(.table, .more) { clear: both; }
}
@page { size: A4; margin: 14mm 15mm; }
@media print {
  :root { color-scheme: light; --ink: #000; --soft: #444; --ground: #fff; --panel: #f6f6f4;
    --line: #ccc; --rule: #000; --link: #000; --warn-ink: #000; --warn-ground: #fff;
    --warn-line: #777; --stamp-ink: #8a1c14; --stamp-ground: #fff; --stamp-line: #b3261e;
    --strong: #e8e8e8; }
  body { font-size: 9pt; line-height: 1.32; }
  header, main, footer { max-width: none; padding: 0; }
  nav, figure details, .more, .further { display: none; }
  h1 { font-size: 18pt; }
  h2 { font-size: 12pt; margin: 5mm 0 2mm; padding-top: 1.5mm; }
  h3 { font-size: 11pt; margin: 5mm 0 2mm; }
  h2, h3 { break-after: avoid; }
  .banner, .warnings { font-size: 9pt; padding: 1.5mm 3mm; margin: 0 0 3mm; }
  .references { font-size: 7pt; line-height: 1.25; columns: 2; }
  p, .warnings li { orphans: 3; widows: 3; max-width: none; }
  a { text-decoration: none; }
  .scroll { overflow: visible; }
  table { font-size: 7.8pt; max-width: 100%; }
  .whole, figure, .warnings li { break-inside: avoid; }
  thead { display: table-header-group; }
  tr { break-inside: avoid; }
  th, td { padding: .6mm 1.6mm; }
  th, td.l { white-space: normal; }
  caption { font-size: 9.5pt; break-after: avoid; }
  caption span { max-width: 175mm; }
  tbody tr:nth-child(even), tbody tr td.s { print-color-adjust: exact;
    -webkit-print-color-adjust: exact; }
  .notes { font-size: 7.8pt; }
  .plot { border: 0; padding: 0; width: calc(var(--cm) * 1cm); }
  figure { margin: 4mm 0; }
  .table { margin: 3mm 0 5mm; }
}
)";

}  // namespace touchtrial::analysis

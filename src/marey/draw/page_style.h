// The style of every page that draw/page.h writes, and what its script does.
#pragma once

namespace marey::draw {

inline constexpr const char* kPageStyle = R"(
:root { color-scheme: light dark; --ground: #fff; --text: #1a2129; --faint: #5d6770; --line: #dfe3e6; --bar: #58a873; --head: #f3f5f6; --mark: #d9480f }
@media (prefers-color-scheme: dark) {
  :root { --ground: #14181c; --text: #e6e9eb; --faint: #9aa3aa; --line: #30373d; --bar: #3f8f5c; --head: #1d2328; --mark: #ff922b }
}
* { box-sizing: border-box }
body { font: 15px/1.45 system-ui, sans-serif; margin: 0 auto; max-width: 84em; padding: 1.6em 1.2em 4em; color: var(--text); background: var(--ground); overflow-wrap: break-word }
h1 { font-size: 1.7em; line-height: 1.2; margin: 0 0 .2em } h2 { margin: 2em 0 .6em; font-size: 1.25em } h3 { margin: 1em 0 .4em; font-size: 1em } p, ul { max-width: 50em } h1 + p { margin-top: 0; color: var(--faint) }
.scroll { overflow-x: auto } table { border-collapse: collapse; min-width: min(100%, 34em); font-variant-numeric: tabular-nums } table.wide { width: 100% }
th, td { padding: .34em .6em; border-bottom: 1px solid var(--line); text-align: left }
td.n, th.n { text-align: right } table.wide th.n { width: 5% } td.n { white-space: nowrap } td.n[style] { background: linear-gradient(90deg, var(--bar) var(--w, 0), transparent var(--w, 0)) .4em calc(100% - 2px) / calc(100% - .8em) 3px no-repeat }
th { background: var(--head); padding: 0; vertical-align: bottom; font-size: .87em; line-height: 1.25; font-weight: 600; hyphens: manual }
th.group { padding: .34em .7em 0; border: 0; text-align: left; color: var(--faint); font-weight: 400; white-space: nowrap } .from { border-left: 1px solid var(--line) }
th button { all: unset; box-sizing: border-box; cursor: pointer; padding: .34em .7em; display: block; width: 100% } th button:focus-visible { outline: 2px solid var(--mark) }
th[aria-sort=ascending] button::after { content: " ▲" } th[aria-sort=descending] button::after { content: " ▼" }
.sort { display: none; margin-bottom: .7em }
.chip { white-space: nowrap } .chip i { display: inline-block; width: .8em; height: .8em; margin-right: .4em; border-radius: 3px; background: var(--c); border: 1px solid #0006; vertical-align: -.05em }
.legend { display: flex; flex-wrap: wrap; gap: .2em 1.2em; margin: .5em 0; font-size: .93em }
svg { display: block; width: 100%; height: auto } svg text { fill: currentColor }
details { margin: .5em 0; border-bottom: 1px solid var(--line) } summary { cursor: pointer; font-weight: 600; padding: .3em 0 }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24em), 1fr)); gap: 1.2em } .four { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 18em), 1fr)); gap: 1em }
figure { margin: 0 } figcaption { color: var(--faint); font-size: .93em; margin-top: .3em } svg .axis { fill: var(--faint) } .grid { stroke: var(--line) } .zero { stroke: var(--faint) }
.before { stroke: var(--text) } .panels { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 16em), 1fr)); gap: .8em } .sheet h2 small { font-weight: 400; font-size: .7em; color: var(--faint); margin-left: .8em }
.speed { stroke: var(--text) } .sprint { fill: var(--mark); fill-opacity: .25 }
@media screen and (max-width: 46em) {
  body { padding: 1em 1em 3em } table { min-width: 100% } th, td, th button { padding-left: .4em; padding-right: .4em }
  table.cards, table.cards tbody { display: block } table.cards thead { display: none } .sort { display: block }
  table.cards tr { display: grid; grid-template-columns: repeat(3, 1fr); border: 1px solid var(--line); border-radius: 8px; padding: .3em; margin-bottom: .7em }
  table.cards td { border: 0; padding: .2em .35em; text-align: left; white-space: normal; min-width: 0; border-radius: 3px } table.cards td.why { grid-column: 1 / -1 }
  table.cards td:not(.n) { font-weight: 600 }
  table.cards td::before { content: attr(data-label); display: block; color: var(--faint); font-size: .72em; font-weight: 400; line-height: 1.25 } table.cards td:empty { display: none }
}
@page { size: A4; margin: 12mm }
@media print {
  :root { --ground: #fff; --text: #000; --faint: #444; --line: #bbb; --bar: #777; --head: #eee }
  body { max-width: none; margin: 0; padding: 0; font-size: 11px; print-color-adjust: exact; -webkit-print-color-adjust: exact }
  .scroll { overflow: visible } table.cards { font-size: 9px } th { font-size: 1em } th, td, th.group, th button { padding: 2px 3px } td { padding-bottom: 5px } td.n { background-size: calc(100% - .8em) 2px } th.group { white-space: normal }
  details, figure, tr { break-inside: avoid } h2, h3, summary { break-after: avoid } thead { display: table-header-group } .four { grid-template-columns: repeat(3, 1fr) } .two { grid-template-columns: repeat(2, 1fr) }
  .sheet ~ .sheet { break-before: page } .sheet h2 { margin: .6em 0 .3em } .sheet ~ .sheet > h2:first-child { margin-top: 0 } .sheet p { margin: .3em 0; max-width: none } .panels { grid-template-columns: repeat(var(--columns), 1fr); gap: 1.5mm 2mm }
}
)";

// Sorts by the column whose head is pressed, or on a phone is chosen, numbers by size; opens everything before it is printed.
inline constexpr const char* kPageScript = R"(
const number = text => text === "" || isNaN(parseFloat(text)) ? -Infinity : parseFloat(text);
function sort(head, down) {
  const table = head.closest("table"), body = table.tBodies[0], column = head.cellIndex, numbers = head.classList.contains("n");
  const value = row => row.cells[column].textContent;
  const rows = [...body.rows].sort((a, b) => numbers ? number(value(a)) - number(value(b)) : value(a).localeCompare(value(b), undefined, {numeric: true}));
  for (const other of table.querySelectorAll("th")) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  body.append(...(down ? rows.reverse() : rows));
}
for (const button of document.querySelectorAll("th button")) button.onclick = () => {
  const head = button.parentElement, numbers = head.classList.contains("n");
  sort(head, head.getAttribute("aria-sort") === (numbers ? "descending" : "ascending") ? !numbers : numbers);
};
for (const table of document.querySelectorAll("table.cards")) {
  const heads = [...table.tHead.rows[table.tHead.rows.length - 1].cells], label = document.createElement("label"), select = document.createElement("select");
  for (const head of heads) select.add(new Option(head.dataset.label));
  label.className = "sort";
  label.append("sorted by ", select);
  select.selectedIndex = -1;
  select.onchange = () => sort(heads[select.selectedIndex], heads[select.selectedIndex].classList.contains("n"));
  table.before(label);
}
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach(each => each.open = true));
)";

}  // namespace marey::draw

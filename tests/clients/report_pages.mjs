// A report's page in Chromium: report_pages.mjs PAGE_FOLDER FOLDER NAME ADDRESS. At 1,400 px, on a phone and on paper nothing is cut off.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, name, address] = process.argv;
const { page, done } = await browse(page_folder, false);
const A4 = Math.floor(((210 - 2 * 12) / 25.4) * 96); // px between the margins that the page asks for

/** What is cut off or wider than its box: sentences. */
function faults() {
  const list = [];
  const wide = document.documentElement;
  if (wide.scrollWidth > wide.clientWidth) list.push(`the page has ${wide.scrollWidth} px in ${wide.clientWidth} px`);
  for (const box of document.querySelectorAll(".scroll")) {
    const title = box.previousElementSibling.textContent;
    if (box.scrollWidth > box.clientWidth) list.push(`${title}: ${box.scrollWidth} px in a box of ${box.clientWidth} px`);
    const edge = box.getBoundingClientRect();
    for (const cell of box.querySelectorAll("th, td")) {
      if (!cell.offsetParent || cell.textContent === "") continue;
      const { left, right } = cell.getBoundingClientRect();
      if (left < edge.left - 0.5 || right > edge.right + 0.5 || cell.scrollWidth > cell.clientWidth + 1) list.push(`${title}: "${cell.textContent}" is cut off`);
    }
  }
  for (const part of document.querySelectorAll("h1, h2, h3, p, li, svg, .legend, figure, summary")) {
    const { left, right, width } = part.getBoundingClientRect();
    if (width && (left < -0.5 || right > wide.clientWidth + 0.5)) list.push(`${part.tagName} "${part.textContent.slice(0, 30)}" is cut off`);
  }
  return list.slice(0, 10);
}

/** Every figure of every table can be read, under a head or with its own label. */
function unread() {
  const list = [];
  for (const table of document.querySelectorAll("table")) {
    const heads = [...table.tHead.rows[table.tHead.rows.length - 1].cells];
    const headed = heads.every((head) => head.getBoundingClientRect().width > 0);
    for (const row of table.tBodies[0].rows) {
      if (row.cells.length !== heads.length) list.push(`a row has ${row.cells.length} cells under ${heads.length} heads`);
      for (const cell of row.cells) {
        if (cell.textContent === "" || cell.closest("details:not([open])")) continue;
        const label = getComputedStyle(cell, "::before").content;
        if (!cell.offsetParent || !(headed || label.length > 2)) list.push(`"${cell.textContent}" has no head`);
        if (parseFloat(getComputedStyle(cell).fontSize) < 8.5) list.push(`"${cell.textContent}" is too small to read`);
      }
    }
    if (table.tBodies[0].rows.length === 0) list.push("a table is empty");
  }
  return list.slice(0, 10);
}

async function check(what, width, height, media) {
  await page.emulateMedia({ media, colorScheme: what === "dark" ? "dark" : "light" });
  await page.setViewportSize({ width, height });
  assert.deepEqual(await page.evaluate(faults), [], `${name}, ${what}`);
  assert.deepEqual(await page.evaluate(unread), [], `${name}, ${what}`);
  await page.screenshot({ path: join(folder, `${name}_${what}.png`), fullPage: true });
}

await page.goto(address);
assert((await page.locator("table").count()) > 0, "there is no table");
await check("screen", 1400, 900, "screen");
await check("dark", 1400, 900, "screen");
await check("phone", 390, 844, "screen");
await page.evaluate(() => document.querySelectorAll("details").forEach((each) => (each.open = true)));
await check("phone_open", 390, 844, "screen");
await check("paper", A4, 1050, "print");
await page.setViewportSize({ width: 1400, height: 900 });
await page.pdf({ path: join(folder, `${name}.pdf`), format: "A4", preferCSSPageSize: true });

// On a phone, where a table's heads are not seen, it is sorted by a list.
await check("phone", 390, 844, "screen");
for (const table of await page.locator("table.cards").all()) {
  const select = table.locator("xpath=preceding-sibling::label/select");
  assert(await select.isVisible(), "nothing sorts the table on a phone");
  const label = await table.locator("th.n[data-label]").last().getAttribute("data-label");
  await select.selectOption({ label });
  const figures = await table.evaluate((element, wanted) => [...element.querySelectorAll(`td[data-label="${wanted}"]`)].map((cell) => parseFloat(cell.textContent)), label);
  assert.deepEqual(figures, [...figures].sort((a, b) => b - a), `not sorted by ${label}`);
}
await done(name);

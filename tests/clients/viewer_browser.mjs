// What the page's tests share: Chromium with the page in it, waiting, and looking.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { join } from "node:path";

export async function browse(page_folder, phone) {
  const { chromium } = createRequire(join(page_folder, "package.json"))("playwright-core");
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--enable-unsafe-swiftshader"] });
  const context = await browser.newContext({ viewport: phone ? { width: 390, height: 844 } : { width: 1280, height: 800 }, hasTouch: phone, colorScheme: "dark" });
  const page = await context.newPage();
  const wrong = [];
  page.on("pageerror", (error) => wrong.push(error.message));
  page.on("console", (message) => message.type() === "error" && wrong.push(message.text()));
  const sleep = (ms) => page.waitForTimeout(ms);
  const text = (selector) => page.textContent(selector);
  /** Asked again and again, for a slow machine draws late. */
  async function eventually(what, holds) {
    for (const end = Date.now() + 60000; Date.now() < end; await sleep(60)) if (await holds()) return;
    assert.fail(`${what}; the page shows ${await shown()}`);
  }
  /** Whether it holds within a while, for what is tried again. */
  async function soon(holds, seconds = 5) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await sleep(60)) if (await holds()) return true;
    return false;
  }
  /** The last sentence and the list, for the one who reads that a test failed. */
  const shown = () => page.evaluate(() => {
    const row = (each) => [each.className, each.querySelector(".name").textContent, each.querySelector(".percent").textContent].join(" ");
    return JSON.stringify({ said: document.querySelector("#said")?.textContent, rows: [...document.querySelectorAll(".row")].map(row) });
  });
  /**
   * The id of the track that was seen most among those that are there and are not called `other`: it will be seen on, unless the machine
   * stalls for so long that every track ends. So the one who does something with it must try again with another one.
   */
  const steadiest = (other = "") => page.evaluate((name) => {
    const rows = [...document.querySelectorAll(".row:not(.gone)")].filter((row) => row.querySelector(".name").textContent !== name);
    const seen = (row) => parseFloat(row.querySelector(".percent").textContent) || 0;
    return rows.sort((a, b) => seen(b) - seen(a))[0]?.dataset.id;
  }, other);
  /** Selects a track of a live run that is not yet called `name`, and types that name; whether that was possible. */
  async function give_name(name) {
    await page.keyboard.press("Escape");
    const id = await steadiest(name);
    if (id === undefined) return false;
    await page.evaluate((track) => document.querySelector(`.row[data-id="${track}"] .name`)?.click(), id);
    await page.keyboard.press("n");
    if (!(await soon(() => page.locator("#name_field").isVisible(), 1))) return false;
    await page.fill("#name_field", name);
    await page.keyboard.press("Enter");
    return true;
  }
  /** The same of something in the page, whose policy forbids what Playwright's own waiting does. */
  const until = (what, condition, argument) => eventually(what, () => page.evaluate(condition, argument));
  /** How many colours a part of the page has, and its pixels as a digest. */
  async function look(selector) {
    const png = (await page.locator(selector).first().screenshot()).toString("base64");
    return page.evaluate(async (data) => {
      const image = new Image();
      image.src = `data:image/png;base64,${data}`;
      await image.decode();
      const canvas = new OffscreenCanvas(image.width, image.height);
      const draw = canvas.getContext("2d");
      draw.drawImage(image, 0, 0);
      const pixels = new Uint32Array(draw.getImageData(0, 0, image.width, image.height).data.buffer);
      let digest = 7;
      for (const pixel of pixels) digest = (Math.imul(digest, 31) + pixel) | 0;
      return { colours: new Set(pixels).size, digest };
    }, png);
  }
  /** Nothing that can be pressed is cut off or covered by another one. */
  async function check_layout() {
    const faults = await page.evaluate(() => {
      // What is scrolled out of its list can be scrolled back.
      const in_sight = (e) => {
        const { left, right, top, bottom } = e.getBoundingClientRect();
        for (let up = e.parentElement; up && up !== document.body; up = up.parentElement) {
          const part = up.getBoundingClientRect();
          const scrolls = /auto|scroll/.test(getComputedStyle(up).overflowY);
          if (scrolls && (top < part.top || bottom > part.bottom || right < part.left || left > part.right)) return false;
        }
        return true;
      };
      const shown = [...document.querySelectorAll("header button, nav button, footer button, footer select, footer canvas, #tabs button, #edit button, #edit input")].filter((e) => e.offsetParent && !e.hidden && in_sight(e));
      const areas = shown.map((e) => [e.id || e.textContent, e.getBoundingClientRect()]);
      const list = document.documentElement.scrollWidth > innerWidth ? ["the page is wider than the window"] : [];
      for (const [name, a] of areas) {
        if (a.left < 0 || a.right > innerWidth + 0.5 || a.top < 0 || a.bottom > innerHeight + 0.5) list.push(`${name} is cut off`);
        if (a.width < 18 || a.height < 18) list.push(`${name} is too small to press`);
        for (const [other, b] of areas)
          if (name < other && a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1) list.push(`${name} and ${other} overlap`);
      }
      return list;
    });
    assert.deepEqual(faults, []);
  }

  /** Ends, where nothing went wrong in the page but what `expected` takes. */
  async function done(scenario, expected = () => false) {
    assert.deepEqual(wrong.filter((line) => !line.includes("GPU stall") && !expected(line)), []);
    await browser.close();
    console.log(`${scenario}: done`);
  }
  return { page, sleep, text, eventually, soon, until, give_name, look, check_layout, done };
}

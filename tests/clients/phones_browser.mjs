// Phones' browsers, played by Chromium: the camera is a canvas that draws this machine's clock as a code of blocks, or Chromium's own
// camera for tests, for which the page must ask its user.
//
//   node phones_browser.mjs PAGE_FOLDER ADDRESS SECONDS canvas|device CAMERA...       prints what each page shows at the end, as JSON
//
// MAREY_VIEW: the address of the run's own page, which another Chromium shows: how old each image is when it is drawn there, ms.
import { createRequire } from "node:module";
import { join } from "node:path";

const [page_folder, address, seconds, source, ...cameras] = process.argv.slice(2);
const { chromium } = createRequire(join(page_folder, "package.json"))("playwright-core");

const DEVICE = ["--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream"];

/** 44 bits of Date.now(), the lowest first, 11 in a row; the first row of blocks is light, then dark, so that levels are known. */
function draw_clock_as_camera() {
  navigator.mediaDevices.getUserMedia = async () => {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [352, 192];
    const context = canvas.getContext("2d");
    const draw = () => {
      const time = BigInt(Date.now());
      for (let bit = 0; bit < 44; bit++) {
        context.fillStyle = (time >> BigInt(bit)) & 1n ? "#fff" : "#000";
        context.fillRect(32 * (bit % 11), 32 + 32 * Math.floor(bit / 11), 32, 32);
      }
      context.fillStyle = "#fff";
      context.fillRect(0, 0, 176, 32);
      context.fillStyle = "#000";
      context.fillRect(176, 0, 176, 32);
      requestAnimationFrame(draw);
    };
    draw();
    return canvas.captureStream(30);
  };
}

/** In the run's page: every image that it draws is read, as long as it shows a code. */
function time_what_is_drawn() {
  const [wide, tall] = [352, 192];
  const small = new OffscreenCanvas(wide, tall).getContext("2d", { willReadFrequently: true });
  const seen = new Set();
  const draw = CanvasRenderingContext2D.prototype.drawImage;
  window.ages = [];
  CanvasRenderingContext2D.prototype.drawImage = function (image, ...where) {
    draw.call(this, image, ...where);
    const now = Date.now();
    if (!(image instanceof ImageBitmap) || seen.has(image)) return;
    seen.add(image);
    small.drawImage(image, 0, 0, wide, tall);
    const { data } = small.getImageData(0, 0, wide, tall);
    const block = (column, row) => data[4 * (wide * (32 * row + 16) + 32 * column + 16) + 1];
    if (block(1, 0) - block(9, 0) < 100) return;
    const level = (block(1, 0) + block(9, 0)) / 2;
    let shown = 0;
    for (let bit = 0; bit < 44; bit++) if (block(bit % 11, 1 + Math.floor(bit / 11)) > level) shown += 2 ** bit;
    window.ages.push(now - shown);
  };
}

async function viewer(address) {
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
  const page = await (await browser.newContext({ viewport: { width: 1000, height: 700 } })).newPage();
  await page.addInitScript(time_what_is_drawn);
  await page.goto(address);
  return { browser, page };
}

async function phone(camera) {
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--ignore-certificate-errors", ...(source === "device" ? DEVICE : [])] });
  const context = await browser.newContext({ viewport: { width: 390, height: 844 }, ignoreHTTPSErrors: true });
  if (source === "canvas") await context.addInitScript(draw_clock_as_camera);
  const page = await context.newPage();
  const wrong = [];
  page.on("pageerror", (error) => wrong.push(error.message));
  await page.goto(`${address}&camera=${camera}`);
  await page.waitForFunction((name) => [...document.querySelectorAll("#camera option")].some((option) => option.value === name), camera);
  await page.selectOption("#camera", camera);
  await page.click("#start");
  return { browser, page, wrong, camera };
}

const phones = [];
for (const camera of cameras) phones.push(await phone(camera));
const view = process.env.MAREY_VIEW ? await viewer(process.env.MAREY_VIEW) : null;
await new Promise((done) => setTimeout(done, 1000 * Number(seconds)));
const shown = [];
for (const { page, wrong, camera } of phones) {
  shown.push({ camera, wrong, problem: await page.textContent("#problem"), figures: await page.textContent("#figures") });
  if (process.env.MAREY_SHOTS) await page.screenshot({ path: join(process.env.MAREY_SHOTS, `phone_${camera}.png`) });
}
const ages = view ? await view.page.evaluate(() => window.ages) : [];
if (view) await view.browser.close();
console.log(JSON.stringify({ pages: shown, ages }));
for (const { browser } of phones) await browser.close();

// Phones' browsers, played by Chromium: the camera is a canvas that draws this machine's clock as a code of blocks, or Chromium's own
// camera for tests, for which the page must ask its user.
//
//   node phones_browser.mjs PAGE_FOLDER ADDRESS SECONDS canvas|device CAMERA...       prints what each page shows at the end, as JSON
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
await new Promise((done) => setTimeout(done, 1000 * Number(seconds)));
const shown = [];
for (const { page, wrong, camera } of phones) {
  shown.push({ camera, wrong, problem: await page.textContent("#problem"), figures: await page.textContent("#figures") });
  if (process.env.MAREY_SHOTS) await page.screenshot({ path: join(process.env.MAREY_SHOTS, `phone_${camera}.png`) });
}
console.log(JSON.stringify(shown));
for (const { browser } of phones) await browser.close();

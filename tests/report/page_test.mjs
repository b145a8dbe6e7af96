// report.html in a real browser: small runs of the program, every control.
//   page_test.mjs PROGRAM FOLDER_WITH_NODE_MODULES ROOT OUTPUT
// With MENISCUS_SCREENSHOTS=1 screenshots are kept in OUTPUT for the eye.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [, , program, web, root, output] = process.argv;
const { chromium } = createRequire(path.join(web, "/"))("playwright-core");

const MOST_BYTES = 8e6;
const COARSE = ["--set", "resolution.fea=20", "--set", "resolution.film=10"];
const TWO_ARM = path.join(root, "cases/two_arm/case.toml");
const INJECTED = "# </script><script>window.injected = 1</script> \u00fc";

const STRUTS = `title = "Struts"
units = "mm-N-MPa"
[parameters]
height = 60
[curves.base]
kind = "circle"
center = [0, 0, 0]
normal = [0, 0, -1]
radius = 25
[curves.head]
kind = "circle"
center = [0, 0, "height"]
normal = [0, 0, 1]
radius = 20
[films.skin]
kind = "branch"
curves = ["base", "head"]
[solids.foot]
kind = "cap"
curve = "base"
[solids.top]
kind = "cap"
curve = "head"
[bodies.part]
enclosed_by = ["skin", "foot", "top"]
volume = "1500 * height"
material = "aluminium"
[resolution]
fea = 10
[materials.aluminium]
youngs_modulus = 71700.0
poisson_ratio = 0.33
density = 2.8e-9
[load_cases.service]
supports = [{ on = "foot", fix = "xyz" }]
loads = [{ on = "top", force = [1000, 0, 0] }]
[responses.sway]
kind = "mean_displacement"
on = "top"
direction = [1, 0, 0]
[responses.mass]
kind = "mass"
[analysis]
buckling = 0
[study]
kind = "family"
each = "analyse"
[study.members.short]
height = 50
[study.members.long]
height = 60
`;

// A chamber of its own that runs into the bracket: it cannot be filled.
const PEG = `
[curves.outer]
kind = "circle"
center = [0, 80, 60]
normal = [0, 1, 0]
radius = 15

[curves.inner]
kind = "circle"
center = [0, 0, 60]
normal = [0, -1, 0]
radius = 15

[films.peg]
kind = "loft"
curves = ["outer", "inner"]

[solids.outer_pad]
kind = "cap"
curve = "outer"

[solids.inner_pad]
kind = "cap"
curve = "inner"

[bodies.peg_body]
enclosed_by = ["peg", "outer_pad", "inner_pad"]
volume = 5.6e4
material = "aluminium"
`;

// A neck far past where a film between its rims tears; and one that no height in
// its bounds makes as stiff as asked.
const TORN = STRUTS.replace("height = 60", "height = 160")
  .replace('volume = "1500 * height"', 'volume = "300 * height"')
  .replace(/\[study\][^]*/, "");
const SOFT = STRUTS.replace('"1500 * height"', '"area * height"').replace(
  "[parameters]\nheight = 60",
  '[parameters]\narea = "1500 mm2"\n[design.height]\ninitial = "60 mm"\nbounds = ["50 mm", "70 mm"]',
).replace(
  /\[study\][^]*/,
  `[study]
kind = "minimize"
objective = "mass"
constraints = [{ response = "sway", max = 1e-6 }]
`,
);

// Heights beyond which its neck closes.
const TEARING = STRUTS.replace("[parameters]\nheight = 60", '[design.height]\ninitial = 60\nbounds = [60, 130]')
  .replace('"1500 * height"', '"1200 * height"')
  .replace(/\[study\][^]*/, '[study]\nkind = "sweep"\ncount = 4\n');

// Twelve points of a foot, design variables under one name.
const PETALS = STRUTS.replace(
  /kind = "circle"\ncenter = \[0, 0, 0\][^]*?radius = 25/,
  `kind = "spline"
points = [{ at = ["t[i, j] * cos((6 * i + j) * pi / 6)", "t[i, j] * sin((6 * i + j) * pi / 6)", 0], repeat = [2, 6] }]`,
)
  .replace("[curves.base]", '[design.t]\nshape = [2, 6]\ninitial = "25 mm"\nbounds = [24, 27]\n[curves.base]')
  .replace(
    /\[study\][^]*/,
    `[study]
kind = "minimize"
objective = "sway"
constraints = [{ response = "mass", max = "1 kg" }]
`,
  );

function run(code, ...args) {
  const done = spawnSync(program, args, { cwd: output, encoding: "utf-8" });
  assert.equal(done.status, code, `${args.join(" ")}:\n${done.stdout}${done.stderr}`);
  return done.stdout + done.stderr;
}

function makeRuns() {
  fs.rmSync(output, { recursive: true, force: true });
  fs.mkdirSync(output, { recursive: true });
  const text = fs.readFileSync(TWO_ARM, "utf-8");
  fs.writeFileSync(path.join(output, "case.toml"), `${INJECTED}\n${text}`);
  run(0, "run", "case.toml", ...COARSE, "--no-pictures", "--out", "arms");
  run(0, "run", "case.toml", ...COARSE, "--no-pictures", "--out", "even", "--set", "load_left=60000");
  fs.writeFileSync(path.join(output, "crossed.toml"), text + PEG);
  run(3, "run", "crossed.toml", "--set", "resolution.fea=8", "--set", "resolution.film=4", "--no-pictures", "--out", "crossed");
  for (const [name, text] of Object.entries({ torn: TORN, soft: SOFT })) {
    fs.writeFileSync(path.join(output, `${name}.toml`), text);
    run(3, "run", `${name}.toml`, "--no-pictures", "--out", name);
  }
  fs.writeFileSync(path.join(output, "tearing.toml"), TEARING);
  run(0, "run", "tearing.toml", "--no-pictures", "--out", "tearing");
  fs.writeFileSync(path.join(output, "struts.toml"), STRUTS);
  run(0, "run", "struts.toml", "--no-pictures", "--out", "struts");
  fs.writeFileSync(path.join(output, "petals.toml"), PETALS);
  const petals = (name, code, ...set) =>
    run(code, "run", "petals.toml", "--no-pictures", "--out", name, ...set.flatMap((text) => ["--set", text]));
  petals("petals", 0);
  petals("petal_sweep", 0, "study.kind=sweep", "study.count=4");
  petals("petal_scatter", 0, "study.kind=tolerance", 'study.deviations={ t = "0.1 mm" }', "study.count=2");
  run(0, "compare", "arms", "even", "--out", "compared");
  // As many members as fit a page, each of its own height.
  const members = Array.from({ length: 28 }, (_, k) => `[study.members.m${k + 1}]\nheight = ${40 + k}\n`).join("");
  fs.writeFileSync(path.join(output, "many.toml"), STRUTS.replace(/\[study\.members[^]*/, members));
  run(0, "run", "many.toml", "--set", "resolution.fea=14", "--no-pictures", "--no-frames", "--out", "many");
  fs.writeFileSync(path.join(output, "open.stl"), "solid left_pad\nendsolid\n");
  run(2, "compare", "arms", "open.stl", "--out", "nothing");
  assert.deepEqual(fs.readdirSync(path.join(output, "nothing")), []);
  // Two designs of a history, whoever wrote them.
  const arms = path.join(output, "arms");
  if (!fs.existsSync(path.join(arms, "frames.pvd"))) {
    fs.mkdirSync(path.join(arms, "frames"));
    for (const n of [1, 2]) {
      fs.copyFileSync(path.join(arms, "film.vtp"), path.join(arms, "frames", `film_000${n}.vtp`));
    }
    const sets = [1, 2].map((n) => `<DataSet timestep="${n}" part="0" file="frames/film_000${n}.vtp"/>`);
    fs.writeFileSync(path.join(arms, "frames.pvd"), `<VTKFile type="Collection"><Collection>${sets.join("\n")}</Collection></VTKFile>\n`);
  }
  run(0, "report", "arms", "--no-pictures");
}

/** Folders that are no results or damaged: told, exit 2, the page left. */
function testDamaged() {
  const folder = path.join(output, "damaged");
  const page = path.join(folder, "report.html");
  const refuse = (pattern) => {
    fs.writeFileSync(page, "as before");
    assert.match(run(2, "report", "damaged", "--no-pictures"), pattern);
    assert.equal(fs.readFileSync(page, "utf-8"), "as before");
    assert.deepEqual(fs.readdirSync(folder).filter((name) => /^\.(?!lock)/.test(name)), []);
  };
  run(2, "report", "nowhere");
  fs.mkdirSync(folder);
  refuse(/no result\.json/);
  const spoil = (name, change) => {
    fs.rmSync(folder, { recursive: true });
    fs.cpSync(path.join(output, "arms"), folder, { recursive: true });
    const file = path.join(folder, name);
    fs.writeFileSync(file, change(fs.readFileSync(file)));
  };
  for (const name of ["result.json", "part.vtu", "part_surface.vtp", "film.vtp"]) {
    spoil(name, (bytes) => bytes.subarray(0, bytes.length / 2));
    refuse(new RegExp(name.replace(".", "\\.")));
  }
  spoil("study.sqlite", (bytes) => bytes.fill(7, 100, 3000));
  refuse(/study\.sqlite/);
  spoil("result.json", () => "[1, 2]");
  refuse(/result\.json/);
  spoil("result.json", (bytes) => bytes.toString().replace(/"status": "\w+"/, '"status": 7'));
  fs.rmSync(page);
  fs.mkdirSync(page);
  assert.match(run(2, "report", "damaged", "--no-pictures"), /report\.html/);
  fs.rmSync(folder, { recursive: true });
}

const FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

class Visit {
  static async to(browser, folder, options = {}) {
    const visit = new Visit();
    visit.faults = [];
    visit.page = await browser.newPage({ viewport: { width: 1280, height: 800 }, ...options });
    visit.page.on("console", (m) => m.type() === "error" && visit.faults.push(m.text()));
    visit.page.on("pageerror", (e) => visit.faults.push(String(e)));
    visit.page.on("request", (r) => {
      if (!/^(file|data|blob):/.test(r.url())) {
        visit.faults.push(`request of ${r.url()}`);
      }
    });
    const file = path.join(output, folder, "report.html");
    assert.ok(fs.statSync(file).size < MOST_BYTES);
    visit.url = pathToFileURL(file).href;
    await visit.page.goto(visit.url);
    await visit.settle();
    return visit;
  }

  /** Until what was asked for is drawn. */
  async settle() {
    await this.page.evaluate(async () => {
      for (let k = 0; k < 4; ++k) {
        await new Promise((done) => requestAnimationFrame(done));
      }
    });
  }

  picture() {
    return this.page.evaluate(() => {
      const text = document.querySelector("canvas").toDataURL();
      let hash = 0;
      for (let i = 0; i < text.length; ++i) {
        hash = (hash * 31 + text.charCodeAt(i)) | 0;
      }
      return hash;
    });
  }

  /** Colours in the canvas. */
  colours() {
    return this.page.evaluate(() => {
      const from = document.querySelector("canvas");
      const copy = document.createElement("canvas");
      copy.width = 160;
      copy.height = 120;
      const context = copy.getContext("2d");
      context.drawImage(from, 0, 0, 160, 120);
      const bytes = context.getImageData(0, 0, 160, 120).data;
      return new Set(new Uint32Array(bytes.buffer)).size;
    });
  }

  async changes(what, act) {
    const before = await this.picture();
    await act();
    await this.settle();
    assert.notEqual(await this.picture(), before, `${what} changes nothing`);
  }

  set(id, value) {
    return this.page.evaluate(
      ([key, v]) => {
        const control = document.getElementById(key);
        control.value = v;
        control.dispatchEvent(new Event(control.type === "range" ? "input" : "change"));
      },
      [id, value],
    );
  }

  press(name) {
    return this.page.evaluate((text) => {
      [...document.querySelectorAll("button")].find((b) => b.textContent === text).click();
    }, name);
  }

  /** For the eye, which is seldom there: a page drawn whole takes a second. */
  async shot(name) {
    if (!process.env.MENISCUS_SCREENSHOTS) {
      return;
    }
    await this.page.screenshot({ path: path.join(output, `${name}.png`), fullPage: true });
  }

  /** What every page must keep; then it is closed. */
  async leave() {
    assert.deepEqual(this.faults, []);
    const problems = await this.page.evaluate(() => {
      const found = [];
      for (const control of document.querySelectorAll("button, input, select")) {
        const label = control.getAttribute("aria-label") ?? control.closest("label")?.textContent ?? control.textContent;
        if (!label.trim()) {
          found.push(`${control.outerHTML} has no name`);
        }
        if (control.tabIndex < 0) {
          found.push(`${control.outerHTML} is out of the keyboard's reach`);
        }
      }
      for (const table of document.querySelectorAll("table")) {
        if (!table.caption?.textContent) {
          found.push(`${table.textContent.slice(0, 80)}: no caption`);
        }
      }
      for (const svg of document.querySelectorAll("figure.chart svg[aria-label]")) {
        if (svg.textContent.includes("NaN")) {
          found.push(`${svg.ariaLabel}: NaN`);
        }
      }
      if (document.documentElement.scrollWidth > window.innerWidth) {
        found.push(`wider than the window: ${document.documentElement.scrollWidth}`);
      }
      // Every mass in kg, charts and tables alike, where the case counts in tonnes.
      for (const node of document.querySelectorAll("main td, main th, main dd, main figcaption, main svg text, .design-text")) {
        if (/\[t\]|[\u202f/]t(?![\w\u00b2\u00b3])/.test(node.textContent)) {
          found.push(`${node.textContent}: in tonnes`);
        }
      }
      if (/undefined|NaN|\[object/.test(document.querySelector("main").innerText)) {
        found.push("undefined, NaN or [object in the text");
      }
      return found;
    });
    assert.deepEqual(problems, []);
    await this.page.close();
  }
}

async function testRun(browser) {
  const visit = await Visit.to(browser, "arms");
  const { page } = visit;
  await visit.shot("arms");
  assert.ok((await visit.colours()) > 100, "the canvas is blank");
  const first = await visit.picture();
  const text = await page.evaluate(() => document.querySelector("main").innerText);
  for (const pattern of [/Two-arm bracket/, /left deflection/, /\u00b1/, /mm/, /MPa/, /40\s?000/]) {
    assert.match(text, pattern);
  }
  assert.equal(await page.evaluate(() => window.injected), undefined);
  assert.equal(await page.evaluate(() => document.querySelector(".code li").textContent), INJECTED);
  assert.ok((await page.evaluate(() => document.querySelectorAll("figure.chart svg rect").length)) > 50);

  for (const field of ["displacement", "energy_density", "stress_error", "mean_curvature", "von_mises"]) {
    await visit.changes(field, () => visit.set("field", field));
    const bar = await page.evaluate(() => document.querySelector(".bar").innerText);
    assert.match(bar, /\[.+\]/);
  }
  // Film at rest: pressure = 2 T H with T = 1 here.
  await visit.set("field", "mean_curvature");
  const curvature = await page.evaluate(() => {
    const range = [...document.querySelectorAll(".panel input[type=number]")].map((i) => Number(i.value));
    return (range[0] + range[1]) / 2;
  });
  const result = JSON.parse(fs.readFileSync(path.join(output, "arms/result.json")));
  const exact = result.film.bodies.part.pressure / 2;
  assert.ok(Math.abs(curvature - exact) < 0.1 * exact, `${curvature}, not ${exact}`);
  await visit.set("field", "von_mises");
  await visit.settle();

  for (const view of ["Front", "Side", "Top", "+", "\u2212", "Oblique"]) {
    await visit.changes(view, () => visit.press(view));
  }
  await visit.changes("cividis", () => visit.set("map", "cividis"));
  await visit.set("map", "viridis");
  await visit.changes("Full range", () => visit.press("Full range"));
  await visit.changes("Without peaks", () => visit.press("Without peaks"));
  await visit.changes("deflection", () => visit.set("deflection", "900"));
  await visit.changes("no deflection", () => visit.press("None"));
  await visit.press("Clear to see");
  await visit.changes("section", () => visit.set("section-axis", "y"));
  await visit.changes("place of the section", () => visit.set("section-level", "300"));
  await visit.changes("other half", () => page.click("#section-flip"));
  await page.click("#section-flip");
  await visit.changes("edges", () => page.click("#edges"));
  await visit.shot("arms_section");
  await visit.set("section-axis", "");
  await page.click("#edges");
  for (const id of ["film", "film-edges", "curves", "loads"]) {
    await visit.changes(id, () => page.click(`#${id}`));
    await page.click(`#${id}`);
  }
  await visit.changes("pushes", () => visit.set("push", "0"));
  await visit.shot("arms_push");
  await visit.set("push", "");
  await visit.changes("history", () => visit.set("history", "0"));
  assert.match(await page.evaluate(() => document.querySelector(".design-text").textContent), /evaluation 1: support x/);
  await visit.shot("arms_history");
  await visit.set("history", "99");

  await page.focus("canvas");
  for (const key of ["ArrowLeft", "ArrowUp", "ArrowRight", "ArrowDown", "+", "-"]) {
    await visit.changes(key, () => page.keyboard.press(key));
  }
  await page.keyboard.press("0");
  await visit.settle();
  assert.equal(await visit.picture(), first, "not as at first");
  await visit.leave();
}

async function testOthers(browser) {
  const phone = await Visit.to(browser, "arms", { viewport: { width: 390, height: 780 }, colorScheme: "dark" });
  await phone.shot("arms_phone");
  await phone.leave();

  const crossed = await Visit.to(browser, "crossed");
  const said = await crossed.page.evaluate(() => document.querySelector("main").innerText);
  assert.match(said, /failed/);
  assert.match(said, /red marks/);
  assert.ok((await crossed.colours()) > 50);
  await crossed.shot("crossed");
  await crossed.leave();

  for (const [name, ...why] of [["torn", /failed/, /pinch|unstable|neck|tear|no film/i], ["soft", /no acceptable design/, /sway/]]) {
    const failed = await Visit.to(browser, name);
    const message = JSON.parse(fs.readFileSync(path.join(output, name, "result.json"), "utf-8")).message;
    const told = await failed.page.evaluate(() => document.querySelector("main").innerText);
    for (const pattern of why) {
      assert.match(told, pattern);
    }
    assert.ok(told.replace(/\s+/g, " ").includes(message.replace(/\s+/g, " ")), message);
    if (name === "soft") {
      for (const pattern of [/area 1500 mm\u00b2/, /height\s+50 mm \(at its lower bound\)[^]*50 to 70\smm/, /at most 1\.?0*\u00d710\u207b\u2076\smm/, /Objective mass \[kg\]/]) {
        assert.match(told.replace(/[\t\u202f]/g, " "), pattern);
      }
      const cards = await failed.page.evaluate(() => [...document.querySelectorAll(".card")].map((c) => c.innerText.replace(/\s+/g, " ")));
      assert.match(cards[0], /^0\.\d+ kg mass$/i);
      const axes = await failed.page.evaluate(() => [...document.querySelectorAll("figure.chart svg text")].map((t) => t.textContent));
      assert.ok(axes.some((t) => t.includes("mass [kg]")), axes.join("; "));
    }
    await failed.shot(name);
    await failed.leave();
  }

  const struts = await Visit.to(browser, "struts");
  assert.equal(await struts.page.evaluate(() => document.querySelectorAll(".pane-title").length), 2);
  await struts.changes("displacement", () => struts.set("field", "displacement"));
  await struts.shot("struts");
  const link = await struts.page.evaluate(() => document.querySelector("#members a").getAttribute("href"));
  assert.ok(fs.existsSync(path.join(output, "struts", link)));
  await struts.leave();

  const compared = await Visit.to(browser, "compared");
  assert.match(await compared.page.evaluate(() => document.querySelector("#comparison").innerText), /stiffness per mass/);
  await compared.changes("Full range", () => compared.press("Full range"));
  await compared.shot("compared");
  await compared.leave();
}

/** Names of 28 members stand over their own parts, none over another. */
/** A vector of design variables is one row, one bar, one column. */
async function testVectors(browser) {
  for (const name of ["petals", "petal_sweep", "petal_scatter"]) {
    const visit = await Visit.to(browser, name);
    const { page } = visit;
    await visit.shot(name);
    const text = await page.evaluate(() => {
      const main = document.querySelector("main").cloneNode(true);
      main.querySelectorAll(".code, .warnings").forEach((part) => part.remove());
      return main.textContent;
    });
    assert.match(text, /t \[2 \u00d7 6\]/);
    assert.doesNotMatch(text, /t\[\d/);
    const rows = await page.evaluate(() =>
      [...document.querySelector("#answer table").querySelectorAll("tbody tr")].map((r) => r.innerText),
    );
    assert.equal(rows.filter((r) => r.startsWith("t [2")).length, 1, rows.join("\n"));
    if (name === "petals") {
      assert.match(rows[0], /to .* mean .*mm/);
      assert.match(rows[0], /25\s?mm each|25\.\d* mm each/);
      assert.match(text, /t \[2 \u00d7 6\], lowest/);
      assert.match(text, /per mm of all of t \[2 \u00d7 6\]/);
      assert.match(text, /What binds, and what it is worth/);
      await visit.changes("pushes", () => visit.set("push", "0"));
    }
    if (name === "petal_sweep") {
      assert.match(text, /over the mean of t \[2 \u00d7 6\], 6 designs/);
    }
    await visit.leave();
  }
}

/** Where a film came to an end on the way. */
async function testEvents(browser) {
  const { topology } = JSON.parse(fs.readFileSync(path.join(output, "tearing", "result.json"), "utf-8"));
  assert.equal(topology[0].kind, "film_pinched");
  const visit = await Visit.to(browser, "tearing");
  await visit.shot("tearing");
  const events = await visit.page.evaluate(() => document.querySelector("#checks .events").innerText);
  assert.match(events, /a neck closes at \d+ designs?, nearest to the start at evaluation \d+: \S/);
  await visit.leave();
}

async function testMany(browser) {
  const many = await Visit.to(browser, "many");
  const cells = await many.page.evaluate(() => {
    const canvas = document.querySelector("canvas");
    const frame = canvas.getBoundingClientRect();
    const copy = document.createElement("canvas");
    copy.width = frame.width;
    copy.height = frame.height;
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0, frame.width, frame.height);
    const titles = [...document.querySelectorAll(".pane-title")].map((t) => [t.textContent, t.getBoundingClientRect()]);
    const lefts = [...new Set(titles.map(([, box]) => Math.round(box.left)))].sort((a, b) => a - b);
    const tops = [...new Set(titles.map(([, box]) => Math.round(box.top)))].sort((a, b) => a - b);
    const width = frame.width / lefts.length;
    const height = frame.height / tops.length;
    return titles.map(([name, box], k) => {
      const pixels = context.getImageData(box.left - frame.left, box.top - frame.top, width, height).data;
      let drawn = 0;
      for (let i = 3; i < pixels.length; i += 4) {
        drawn += pixels[i] > 0 ? 1 : 0;
      }
      return {
        name,
        column: lefts.indexOf(Math.round(box.left)),
        row: tops.indexOf(Math.round(box.top)),
        columns: lefts.length,
        inside: box.left >= frame.left - 1 && box.right <= frame.right + 1 && box.top >= frame.top - 1 && box.bottom <= frame.bottom + 1,
        drawn,
        k,
        area: width * height,
      };
    });
  });
  assert.equal(cells.length, 28);
  for (const cell of cells) {
    assert.equal(cell.name, `m${cell.k + 1}`);
    assert.equal(cell.row * cell.columns + cell.column, cell.k, cell.name);
    assert.ok(cell.inside, `${cell.name} lies beside the canvas`);
    assert.ok(cell.drawn > 0.02 * cell.area, `nothing is drawn below ${cell.name}`);
  }
  assert.ok(cells[0].columns < 28 && cells[0].columns > 3, `${cells[0].columns} columns`);
  await many.shot("many");
  await many.leave();
}

async function testWithoutWebgl() {
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-3d-apis"] });
  const visit = await Visit.to(browser, "arms");
  assert.match(await visit.page.evaluate(() => document.getElementById("no-webgl").textContent), /WebGL/);
  assert.ok((await visit.page.evaluate(() => document.querySelectorAll("figure.chart svg").length)) >= 4);
  await visit.leave();
  await browser.close();
}

makeRuns();
testDamaged();
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
try {
  await testRun(browser);
  await testOthers(browser);
  await testVectors(browser);
  await testEvents(browser);
  await testMany(browser);
} finally {
  await browser.close();
}
await testWithoutWebgl();
console.log(`pages in ${output}`);

// The page of the desk. Its state is a file and texts by path for one or two variants; the address bar holds it.
// Figures are asked for one request at a time, always with the newest values; curves follow when the hand rests.

const $ = (id) => document.getElementById(id);
const make = (tag, attributes = {}, ...content) => {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value != null) node.setAttribute(name, value);
  }
  node.append(...content);
  return node;
};
const SVG = "http://www.w3.org/2000/svg";
const svg = (tag, attributes = {}, ...content) => {
  const node = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...content);
  return node;
};
const copy = (state) => JSON.parse(JSON.stringify(state));
const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);

const PAUSE = 600; // milliseconds of rest from which curves are calculated
const LEAST_SPAN = 0.05; // of the power: a curve that hardly changes is drawn nearly level
const SLOW = 0.3; // seconds of an answer from which a drag is shown the own load first
let about = { files: [], kinds: [], systems: [], folder: "" };
let form = null; // fields of the open file
let rows = new Map(); // by path
let state = { file: "", a: {}, b: null, side: "a", units: "", names: ["A", "B"] };
let history = [], at = -1; // states for undo
let curves = new Map(); // by path of the slider: what it is of, points, passing
let dragging = "", lastSeconds = 0, firstErrors = [];

class Refused extends Error {
  constructor(errors) { super("refused"); this.errors = errors; }
}

const errorsOf = (problem) => problem.errors ?? [{ path: "", message: String(problem) }];
const said = (problem) => errorsOf(problem).map((one) => `${one.path ? `${one.path}: ` : ""}${one.message}`).join("\n");

async function post(path, body, signal) {
  let reply;
  try {
    const raw = body instanceof Blob;
    reply = await fetch(path, { method: "POST", signal, body: raw ? body : JSON.stringify(body),
      headers: { "content-type": raw ? "application/octet-stream" : "application/json" } });
  } catch (problem) {
    if (signal?.aborted) throw problem;
    throw new Refused([{ path: "", message: "The desk has ended. Start it again with conveyor desk and its files; the address bar holds what you changed." }]);
  }
  if (reply.status === 422) throw new Refused((await reply.json()).errors);
  if (!reply.ok) throw new Refused([{ path: "", message: reply.status < 500 ? await reply.text() : "The desk failed at this; please report it with the file and the changed fields." }]);
  if (!reply.headers.get("content-type").startsWith("application/json")) return reply.blob();
  const read = await reply.json();
  if (read.stopped) throw new DOMException("stopped", "AbortError");
  return read;
}

// ---- state, address bar, undo

const changes = () => state[state.side];
const baseText = (path) => rows.get(path)?.value ?? "";
const textOf = (path) => changes()[path] ?? baseText(path);

function writeAddress() {
  const words = new URLSearchParams({ file: state.file });
  if (state.units) words.set("units", state.units);
  for (const [path, text] of Object.entries(state.a)) words.append(`a:${path}`, text);
  if (state.b) {
    words.set("side", state.side);
    if (!same(state.names, ["A", "B"])) words.set("names", JSON.stringify(state.names));
    for (const [path, text] of Object.entries(state.b)) words.append(`b:${path}`, text);
  }
  window.history.replaceState(null, "", `#${words}`);
}

function readAddress() {
  const words = new URLSearchParams(location.hash.slice(1));
  const read = { file: words.get("file") ?? "", a: {}, b: words.has("side") ? {} : null,
    side: words.get("side") === "b" ? "b" : "a", units: words.get("units") ?? "", names: ["A", "B"] };
  try { read.names = JSON.parse(words.get("names")) ?? read.names; } catch { /* names as usual */ }
  if (!Array.isArray(read.names) || read.names.length !== 2) read.names = ["A", "B"];
  for (const [key, text] of words) {
    const side = key[1] === ":" && (key[0] === "a" || key[0] === "b") ? key[0] : "";
    if (side && read[side]) read[side][key.slice(2)] = text;
  }
  return read;
}

function keep(open = "") {
  const now = copy(state);
  if (at >= 0 && same(history[at].state, now)) { history[at].open = open; return; }
  if (open && at >= 0 && history[at].open === open) history[at].state = now;
  else { history = history.slice(0, at + 1); history.push({ state: now, open }); at = history.length - 1; }
  $("undo").disabled = at <= 0;
  $("redo").disabled = at >= history.length - 1;
}

function step(by) {
  if (at + by < 0 || at + by >= history.length) return;
  at += by;
  history[at].open = "";
  const { units } = state;
  state = { ...copy(history[at].state), units };
  $("undo").disabled = at <= 0;
  $("redo").disabled = at >= history.length - 1;
  reflect();
  ask();
}

function change(path, text, open = "") {
  const mine = changes();
  if (text === baseText(path)) delete mine[path];
  else mine[path] = text;
  keep(open);
  reflect(path);
  ask();
}

// ---- figures: one request in flight, the newest values next

let flying = false, again = false, resting = null, pause = 0;

async function ask() {
  if (flying) { again = true; return; }
  flying = true;
  try {
    do {
      again = false;
      await answer();
    } while (again);
  } finally { flying = false; }
  restSoon();
}

function restSoon(after = PAUSE) {
  clearTimeout(pause);
  pause = setTimeout(() => { if (!flying) rest(); }, after);
}

async function answer() {
  resting?.abort();
  resting = null;
  if (!form) return;
  const every = !(dragging && lastSeconds > SLOW);
  const other = state.b ? state[state.side === "a" ? "b" : "a"] : null;
  try {
    const got = await post("/answer", { file: state.file, changes: changes(), beside: other, second: state.side === "b",
      names: state.names, units: state.units, every });
    if (got.every) lastSeconds = got.seconds;
    if (got.digest !== form.digest) await loadForm();
    for (const part of document.querySelectorAll("[data-part]")) {
      const html = got.parts[part.dataset.part] ?? (got.every ? "" : part.shown);
      if (part.shown === html) continue;
      const opened = [...part.querySelectorAll("details")].map((one) => one.open);
      part.innerHTML = part.shown = html;
      part.querySelectorAll("details").forEach((one, i) => { one.open = opened[i] ?? one.open; });
    }
    nameVerdicts();
    markStudies();
    $("answer").classList.remove("stale");
    $("answer").classList.toggle("waiting", !got.every);
    $("answer").hidden = false;
    $("command").textContent = got.command;
    showErrors(got.beside.map((one) => ({ ...one, other: true })));
    if (!got.every && !dragging) again = true;
    if (got.every && !again) announce();
  } catch (problem) {
    if (problem.name === "AbortError") { again = true; return; }
    $("answer").classList.add("stale");
    showErrors(errorsOf(problem));
  }
}

function nameVerdicts() {
  const places = [["verdict", state.side === "b" ? 1 : 0], ["verdict_beside", state.side === "b" ? 0 : 1]];
  for (const [part, rank] of places) {
    const node = document.querySelector(`[data-part=${part}]`);
    node.style.order = state.b ? rank : 0;
    const strong = node.querySelector("strong");
    node.querySelector(".variant")?.remove();
    if (state.b) strong?.before(make("span", { class: "variant" }, state.names[rank]));
  }
  $("comparison").hidden = !state.b;
}

function announce() {
  const number = document.querySelector("[data-part=power] .large")?.textContent ?? "";
  const verdict = document.querySelector("[data-part=verdict] strong")?.textContent ?? "";
  $("status").textContent = `Motor power ${number}. ${verdict}.`;
  $("brief").textContent = `${number} · ${verdict}`;
}

function showErrors(errors) {
  firstErrors = errors;
  for (const node of document.querySelectorAll("[data-error]")) {
    const found = errors.filter((one) => !one.other && one.path === node.dataset.error);
    node.textContent = found.map((one) => one.message).join("; ");
    const block = node.closest(".input, .field");
    block.classList.toggle("refused", found.length > 0);
    for (const field of block.querySelectorAll("input, select")) {
      if (found.length) field.setAttribute("aria-invalid", "true");
      else field.removeAttribute("aria-invalid");
    }
  }
  $("alerts").replaceChildren(...errors.slice(0, 6).map((one) => {
    const words = `${one.other ? `Variant beside: ` : ""}${one.path ? `${one.path}: ` : ""}${one.message}`;
    if (!one.path || one.other) return make("p", {}, words);
    return make("p", {}, make("button", { type: "button", onclick: () => goTo(one.path) }, words));
  }));
}

function goTo(path) {
  let field = document.querySelector(`[data-path="${CSS.escape(path)}"]`);
  if (!field) {
    $("find").value = path;
    showFields();
    field = document.querySelector(`[data-path="${CSS.escape(path)}"]`);
  }
  field?.closest("details")?.setAttribute("open", "");
  field?.focus();
}

// ---- curves below the sliders, when the hand rests

const curveKey = (slider) => {
  const others = { ...changes() };
  delete others[slider.path];
  return JSON.stringify([state.file, form.digest, others, state.units]);
};

async function rest() {
  if (!form || dragging || firstErrors.some((one) => !one.other)) return;
  resting?.abort();
  const going = resting = new AbortController();
  const body = { file: state.file, changes: changes(), units: state.units };
  const stale = form.sliders.filter((one) => curves.get(one.path)?.key !== curveKey(one));
  stale.forEach((one) => { curves.get(one.path) && (curves.get(one.path).passing = null); drawCurve(one); });
  try {
    if (tabled !== $("table").value + design()) await showTable(going.signal);
    if (stale.length) {
      const keys = stale.map(curveKey);
      const got = await post("/curves", { ...body, paths: stale.map((one) => one.path) }, going.signal);
      stale.forEach((one, i) => { curves.set(one.path, { key: keys[i], points: got.curves[i], unit: got.unit, passing: null }); drawCurve(one); });
    }
    for (const [key, held] of opened) if (held.of !== design()) await runStudy(key, held, going.signal);
    for (const slider of form.sliders) {
      const curve = curves.get(slider.path);
      if (!curve || curve.passing || curve.key !== curveKey(slider)) continue;
      const got = await post("/passing", { ...body, paths: [slider.path] }, going.signal);
      curve.passing = got.passing;
      drawCurve(slider);
    }
  } catch (problem) {
    if (problem.name === "AbortError" && !going.signal.aborted) setTimeout(() => { if (resting === going) restSoon(); }, PAUSE);
  }
}

function drawCurve(slider) {
  const place = document.querySelector(`[data-curve="${CSS.escape(slider.path)}"]`);
  const curve = curves.get(slider.path);
  if (!place || !curve) return;
  const W = 300, H = 30, pad = 8;
  const values = curve.points.map((point) => point[0]), power = curve.points.map((point) => point[1]);
  const known = power.filter((one) => one != null);
  const fresh = curve.key === curveKey(slider);
  const low = Math.min(...known), high = Math.max(...known);
  const span = Math.max(high - low, LEAST_SPAN * Math.max(Math.abs(low), Math.abs(high))) || 1, foot = (low + high - span) / 2;
  const x = (i) => pad + (W - 2 * pad) * (slider.series.length ? i / (values.length - 1) : (values[i] - slider.low) / (slider.high - slider.low));
  const y = (p) => H - 4 - (H - 8) * (p - foot) / span;
  const parts = [];
  (curve.passing ?? []).forEach((passes, i) => {
    if (!passes) return;
    const from = i ? (x(i - 1) + x(i)) / 2 : x(0), to = i < values.length - 1 ? (x(i) + x(i + 1)) / 2 : x(i);
    parts.push(svg("rect", { x: from, y: 0, width: Math.max(to - from, 0), height: H, class: "ok" }));
  });
  const number = parseFloat(textOf(slider.path));
  const here = slider.series.length ? x(nearest(slider.series, number)) : pad + (W - 2 * pad) * Math.min(1, Math.max(0, (number - slider.low) / (slider.high - slider.low)));
  parts.push(svg("line", { x1: here, x2: here, y1: 0, y2: H, class: "here" }));
  const line = power.map((p, i) => (p == null ? null : `${x(i).toFixed(1)},${y(p).toFixed(1)}`)).filter(Boolean).join(" ");
  parts.push(svg("polyline", { points: line, class: "l s0", "vector-effect": "non-scaling-stroke" }));
  const passing = (curve.passing ?? []).map((passes, i) => (passes ? values[i] : null)).filter((one) => one != null);
  const said = known.length ? `${figure(low, high)} to ${figure(high, low)} ${curve.unit}` : "no answer over the range";
  const drawn = svg("svg", { viewBox: `0 0 ${W} ${H}`, preserveAspectRatio: "none", class: "curve", role: "img",
    "aria-label": `Motor power ${said} over the range${curve.passing ? passing.length ? `; every check passes from ${passing[0]} to ${passing.at(-1)} ${slider.unit}` : "; no value passes every check" : ""}` }, ...parts);
  drawn.style.opacity = fresh ? 1 : 0.4;
  place.replaceChildren(drawn);
  place.nextElementSibling.nextElementSibling.children[1].textContent = fresh && known.length ? said : "";
}

const figure = (value, other) => value.toLocaleString("en", { maximumSignificantDigits: Math.abs(value) >= 1000 || Math.abs(value - other) < 0.02 * Math.abs(value) ? 4 : 3 });
const nearest = (series, value) => series.reduce((best, one, i) => (Math.abs(one - value) < Math.abs(series[best] - value) ? i : best), 0);

// ---- inputs

function editor(row, id) {
  const given = { id, "data-path": row.path, "aria-describedby": `e-${id}` };
  const set = (event) => change(row.path, event.target.value.trim());
  const options = row.kind === "reference" ? form.compounds : row.kind === "switch" ? ["true", "false"] : row.choices;
  if (options?.length) {
    const now = textOf(row.path);
    const every = [...new Set([...(row.required ? [] : [""]), now, ...options.filter((one) => one.toLowerCase() !== now.toLowerCase())])];
    const field = make("select", { ...given, onchange: set }, ...every.map((one) => make("option", { value: one }, one || "–")));
    field.value = now;
    return field;
  }
  const field = make("input", { ...given, type: "text", class: (row.value ?? "").length > 10 ? "wide" : null, autocomplete: "off", spellcheck: "false", placeholder: row.example ?? "", onchange: set });
  field.value = textOf(row.path);
  return field;
}

const resetButton = (row) => make("button", { type: "button", class: "reset", title: `Back to ${row.value ?? "nothing"}`, "aria-label": `Reset ${row.label}`, onclick: () => change(row.path, row.value ?? "") }, "×");

function sliderBlock(slider) {
  const row = rows.get(slider.path), id = `s-${slider.path}`;
  const text = (number) => `${+number.toPrecision(7)} ${slider.unit}`.trim();
  const drag = (event) => {
    dragging = slider.path;
    const number = slider.series.length ? slider.series[+event.target.value] : +event.target.value;
    change(slider.path, Math.abs(number - slider.value) < 0.501 * slider.step && !slider.series.length ? row.value : text(number), slider.path);
  };
  const drop = () => { if (dragging) { dragging = ""; history[at].open = ""; if ($("answer").classList.contains("waiting")) ask(); else if (!flying) restSoon(); } };
  const range = make("input", { type: "range", "data-range": slider.path, "aria-label": `${slider.label}, slider`,
    min: slider.series.length ? 0 : slider.low, max: slider.series.length ? slider.series.length - 1 : slider.high, step: slider.series.length ? 1 : slider.step,
    oninput: drag, onchange: drop, onpointerup: drop, onblur: drop });
  return make("div", { class: "input", "data-block": slider.path },
    make("div", { class: "head" }, make("label", { for: id, title: row.doc }, slider.label), editor(row, id), resetButton(row)),
    make("div", { "data-curve": slider.path, class: "curve" }), range,
    make("div", { class: "ends" }, make("span", {}, text(slider.low)), make("span"), make("span", {}, text(slider.high))),
    make("p", { class: "error", id: `e-${id}`, "data-error": slider.path }));
}

function fieldBlock(row, prefix) {
  const id = `${prefix}-${row.path}`;
  const origin = row.given_by === "default" ? make("span", { class: "tag" }, "default") : row.given_by === "library" ? make("span", { class: "tag" }, "library") : row.given_by ? "" : make("span", { class: "tag" }, row.required ? "needed" : "not given");
  return make("div", { class: "field", "data-block": row.path },
    make("div", { class: "head" }, make("label", { for: id, title: row.path }, row.label), editor(row, id), resetButton(row)),
    make("p", { class: "error", id: `e-${id}`, "data-error": row.path }),
    make("p", { class: "note" }, origin, ` ${row.doc ?? ""}${row.allowed ? ` Allowed: ${row.allowed}.` : ""} `, make("code", {}, row.path)));
}

function build() {
  $("sliders").replaceChildren(...form.sliders.map(sliderBlock));
  const covers = form.rows.filter((row) => row.kind === "reference" && row.value);
  $("covers").replaceChildren(...covers.reverse().map((row) => {
    const id = `c-${row.path}`;
    return make("div", { class: "input", "data-block": row.path },
      make("div", { class: "head" }, make("label", { for: id, title: row.doc }, row.label.replace(" compound", "")), editor(row, id), resetButton(row)),
      make("p", { class: "error", id: `e-${id}`, "data-error": row.path }));
  }));
  showFields();
}

function showFields() {
  const words = $("find").value.toLowerCase().split(/\s+/).filter(Boolean);
  if (!words.length) {
    const parts = Map.groupBy ? Map.groupBy(form.rows, (row) => row.part ?? "general") : form.rows.reduce((m, row) => m.set(row.part ?? "general", [...(m.get(row.part ?? "general") ?? []), row]), new Map());
    $("fields").replaceChildren(...[...parts].map(([part, of]) => {
      const held = make("div");
      return make("details", { ontoggle: () => { if (!held.hasChildNodes()) { held.append(...of.map((row) => fieldBlock(row, "f"))); reflect(); showErrors(firstErrors); } } },
        make("summary", {}, `${part} (${of.length})`), held);
    }));
    return;
  }
  const score = (row) => {
    const name = `${row.label} ${row.path}`.toLowerCase(), all = `${name} ${row.doc ?? ""}`.toLowerCase();
    return words.every((word) => all.includes(word)) ? words.filter((word) => name.includes(word)).length + (row.value ? 0.5 : 0) : 0;
  };
  const found = form.rows.map((row) => [score(row), row]).filter(([points]) => points > 0).sort((one, other) => other[0] - one[0]);
  const shown = found.slice(0, 24).map(([, row]) => fieldBlock(row, "f"));
  $("fields").replaceChildren(...shown, make("p", { class: "note", role: "status" }, found.length ? found.length > 24 ? `24 of ${found.length} fields` : `${found.length} ${found.length > 1 ? "fields" : "field"}` : "No field of this name or meaning."));
  reflect();
  showErrors(firstErrors);
}

function reflect() {
  if (!form) return;
  for (const field of document.querySelectorAll("[data-path]")) {
    const text = textOf(field.dataset.path);
    if (document.activeElement !== field || field.tagName === "SELECT" || dragging) field.value = text;
    field.closest("[data-block]").classList.toggle("changed", field.dataset.path in changes());
  }
  for (const slider of form.sliders) {
    const range = document.querySelector(`[data-range="${CSS.escape(slider.path)}"]`);
    const text = textOf(slider.path), number = parseFloat(text);
    range.disabled = text.replace(/^[\s+\-\d.eE]*/, "").trim() !== slider.unit;
    if (dragging !== slider.path) range.value = slider.series.length ? nearest(slider.series, number) : number;
    range.setAttribute("aria-valuetext", text);
    drawCurve(slider);
  }
  const mine = Object.entries(changes());
  $("changed").hidden = !mine.length;
  $("changes").replaceChildren(...mine.map(([path, text]) => make("li", {}, make("span", {}, `${rows.get(path)?.label ?? path}: `, make("del", {}, baseText(path) || "not given"), " ", make("ins", {}, text || "as by default")),
    make("button", { type: "button", class: "reset", style: false, "aria-label": `Reset ${path}`, onclick: () => change(path, baseText(path)) }, "×"))));
  for (const button of $("changes").querySelectorAll(".reset")) button.style.visibility = "visible";
  $("compare").setAttribute("aria-pressed", String(!!state.b));
  for (const button of $("units").children) button.setAttribute("aria-pressed", String(button.value === (state.units || form.units)));
  showSides();
  printHead();
  writeAddress();
}

function showSides() {
  const place = $("sides");
  place.hidden = !state.b;
  if (!state.b) { place.replaceChildren(); place.shown = ""; return; }
  const key = JSON.stringify([state.side, state.names, Object.keys(state.a).length, Object.keys(state.b).length]);
  if (place.shown === key) return;
  place.shown = key;
  const side = (name, i) => make("button", { type: "button", class: "side", "aria-pressed": String(state.side === name), onclick: () => { state.side = name; keep(); build(); reflect(); ask(); } },
    make("strong", {}, state.names[i]), make("small", {}, Object.keys(state[name]).length ? `${Object.keys(state[name]).length} changed` : "as the file"));
  const rename = (i) => make("input", { "aria-label": `Name of variant ${"AB"[i]}`, value: state.names[i], maxlength: 30, onchange: (event) => { state.names[i] = event.target.value.trim() || "AB"[i]; keep(); reflect(); ask(); } });
  const button = (words, title, act) => make("button", { type: "button", title, onclick: () => { act(); keep(); build(); reflect(); ask(); } }, words);
  place.replaceChildren(side("a", 0), side("b", 1), make("div", { class: "all" },
    button("Swap", "The second becomes the first", () => { [state.a, state.b] = [state.b, state.a]; state.names.reverse(); }),
    button(`Keep ${state.names[1]}`, "Go on with the second alone", () => { state.a = state.b; state.b = null; state.side = "a"; state.names = ["A", "B"]; }),
    button(`Drop ${state.names[1]}`, "Go on with the first alone", () => { state.b = null; state.side = "a"; state.names = ["A", "B"]; })),
    make("details", { class: "all" }, make("summary", {}, "Names"), rename(0), rename(1)));
}

function printHead() {
  const place = document.querySelector(".printed") ?? $("main").insertBefore(make("div", { class: "printed" }), $("answer"));
  const lines = (side) => Object.entries(state[side] ?? {}).map(([path, text]) => `${path} ${text}`).join("; ") || "as the file";
  place.replaceChildren(make("h1", {}, form.title), make("p", {}, `${state.file}, conveyor ${about.version}, ${new Date().toISOString().slice(0, 10)}`),
    make("p", {}, state.b ? `${state.names[0]}: ${lines("a")} – ${state.names[1]}: ${lines("b")}` : `Changed: ${lines("a")}`));
}

// ---- longer studies: those that are opened are made again when the hand rests, and stopped by the next input

let study = ""; // the one that runs
const opened = new Map(); // by key: what it was made of, and where it stands
const design = () => JSON.stringify([state.file, form.digest, changes(), state.units]);

function openStudy(key) {
  const held = opened.get(key);
  if (held) {
    held.node.remove();
    opened.delete(key);
    if (study === key) resting?.abort();
  } else {
    const node = make("section", { "aria-label": form.studies[key] });
    opened.set(key, { of: "", node });
    $("further").append(node);
  }
  offerStudies();
  restSoon(0);
}

async function runStudy(key, held, signal) {
  const of = design(), id = `${Math.random()}`;
  study = key;
  $("progress").hidden = $("cancel").hidden = false;
  $("progress").removeAttribute("value");
  $("furthersaid").textContent = form.studies[key];
  const watch = setInterval(async () => {
    const got = await post("/progress", { id }).catch(() => ({ whole: 0 }));
    if (got.whole) { $("progress").max = got.whole; $("progress").value = got.done; }
  }, 500);
  try {
    const got = await post("/further", { file: state.file, changes: changes(), units: state.units, key, id }, signal);
    held.node.innerHTML = got.part;
  } catch (problem) {
    if (problem.name === "AbortError") throw problem;
    held.node.textContent = `${form.studies[key]}: ${said(problem)}`;
  } finally {
    clearInterval(watch);
    study = "";
    $("progress").hidden = $("cancel").hidden = true;
    $("furthersaid").textContent = "";
  }
  held.of = of;
  $("status").textContent = `${form.studies[key]}: calculated.`;
  markStudies();
}

function markStudies() {
  for (const { of, node } of opened.values()) node.classList.toggle("old", of !== design());
  $("tabled").classList.toggle("old", tabled !== $("table").value + design());
}

function offerStudies() {
  for (const [key, held] of opened) if (!(key in form.studies)) { held.node.remove(); opened.delete(key); }
  $("offered").replaceChildren(...Object.entries(form.studies).map(([key, words]) => make("button", { type: "button", "aria-pressed": String(opened.has(key)), onclick: () => openStudy(key) }, words)));
}

// ---- files

async function loadForm() {
  form = await post("/form", { file: state.file });
  rows = new Map(form.rows.map((row) => [row.path, row]));
  form.rows.forEach((row) => { row.value ??= null; });
  $("title").textContent = form.title;
  document.title = `${form.title} – conveyor desk`;
  $("foot").textContent = `${state.file} ${form.own ? "is saved in" : "is not saved yet; it will be in"} ${form.folder}. conveyor ${about.version}; on this machine only.`;
  build();
  offerStudies();
}

const put = new Map(); // by file: what was changed there before another file was opened

async function openFile(read) {
  if (state.file && state.file !== read.file) put.set(state.file, { state, history, at });
  const before = same(read, fresh(read.file)) ? put.get(read.file) : null;
  state = before ? { ...before.state, units: read.units } : read;
  history = before?.history ?? [];
  at = before?.at ?? -1;
  curves = new Map();
  showErrors([]);
  $("start").hidden = true;
  document.body.classList.remove("empty");
  try {
    await loadForm();
  } catch (problem) {
    showErrors(errorsOf(problem));
    return;
  }
  listFiles();
  keep();
  $("undo").disabled = at <= 0;
  $("redo").disabled = at >= history.length - 1;
  reflect();
  await ask();
}

const fresh = (file) => ({ file, a: {}, b: null, side: "a", units: state.units, names: ["A", "B"] });

function listFiles() {
  const news = about.kinds.map((kind) => make("option", { value: `new:${kind}` }, `new: ${kind}`));
  $("file").replaceChildren(...about.files.map((file) => make("option", { value: file }, file)),
    make("option", { value: "open:" }, "open a file …"), make("optgroup", { label: "New spec" }, ...news));
  $("file").value = state.file;
}

async function newSpec(kind, units = state.units || "SI") {
  const got = await post("/new", { kind, units });
  about.files = got.files;
  await openFile({ ...fresh(got.file), units: "" });
}

async function dropFile(file) {
  try {
    const got = await post(`/drop?name=${encodeURIComponent(file.name)}`, file);
    about.files = got.files;
    await openFile(fresh(got.file));
  } catch (problem) {
    showErrors(errorsOf(problem));
    listFiles();
  }
}

function showStart() {
  const place = $("start");
  place.hidden = false;
  document.body.classList.add("empty");
  const kinds = (units) => make("div", {}, ...about.kinds.map((kind) => make("button", { type: "button", onclick: () => newSpec(kind, units) }, `${kind}, ${units}`)));
  place.replaceChildren(make("h2", {}, "Begin a design"), make("p", {}, "A conveyor to start from; every value can be changed."),
    ...about.systems.map(kinds), make("h2", {}, "Or open one"), make("p", {}, "Drop a spec (.yaml, .json) or a filled-in template (.xlsx) on this page."),
    make("div", {}, make("button", { type: "button", onclick: () => $("upload").click() }, "Open a file …")));
  listFiles();
  $("file").prepend(make("option", { value: "", selected: true }, "no file open"));
  $("file").value = "";
}

// ---- saving

function download(blob, name) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

async function save(kind) {
  $("save").open = false;
  if (kind === "print") { window.print(); return; }
  if (kind === "spec") { openSaver(); return; }
  const stem = state.file.replace(/\.[^.]+$/, "");
  $("status").textContent = "Writing the file.";
  document.body.style.cursor = "progress";
  try {
    const body = { file: state.file, changes: changes(), units: state.units };
    if (kind === "study") download(await post("/study", { ...body, changes: state.a, beside: state.b }), `${stem}-study.yaml`);
    else download(await post("/report", { ...body, kind }), stem + { workbook: ".xlsx", pdf: ".pdf", page: ".html" }[kind]);
    $("status").textContent = "The file is in your downloads.";
  } catch (problem) {
    if (problem.name !== "AbortError") showErrors(errorsOf(problem));
  }
  document.body.style.cursor = "";
}

function openSaver() {
  $("target").value = form.saved;
  $("saver").showModal();
  showDifference();
}

let differences = 0; // the newest is that of the name shown

async function showDifference() {
  const mine = ++differences;
  const refuse = (words) => { $("saveerror").textContent = words; $("saveerror").hidden = !words; };
  $("dosave").disabled = true;
  try {
    const got = await post("/difference", { file: state.file, changes: changes(), target: $("target").value.trim() });
    if (mine !== differences) return;
    $("folder").textContent = `in ${got.folder}`;
    $("replacer").hidden = !got.exists;
    $("diff").replaceChildren(...(got.lines.length ? got.lines.map((line) => make("span", { class: line[0] === "+" ? "add" : line[0] === "-" ? "del" : null }, line)) : ["Nothing changes."]));
    refuse("");
    $("dosave").disabled = got.exists && !$("replace").checked;
  } catch (problem) {
    if (mine !== differences) return;
    $("diff").replaceChildren();
    refuse(said(problem));
  }
}

async function doSave() {
  try {
    const saved = copy(changes());
    const got = await post("/save", { file: state.file, changes: saved, target: $("target").value.trim(), digest: form.digest, replace: $("replace").checked });
    $("saver").close();
    about.files = got.files;
    rebase(saved, got.file);
    await loadForm();
    listFiles();
    reflect();
    $("status").textContent = `Saved ${got.saved} in ${got.folder}.`;
    $("foot").textContent = `Saved ${got.saved} in ${got.folder}.`;
    ask();
  } catch (problem) {
    $("saveerror").textContent = said(problem);
    $("saveerror").hidden = false;
  }
}

function rebase(saved, file) {
  // what a state does not change had the old value: it says so from now on
  const old = Object.fromEntries(Object.keys(saved).map((path) => [path, baseText(path)]));
  const over = (side) => {
    const made = { ...old, ...side };
    for (const path of Object.keys(made)) if (made[path] === (path in saved ? saved[path] : baseText(path))) delete made[path];
    return made;
  };
  const all = (one) => ({ ...one, file, a: over(one.a), b: one.b && over(one.b) });
  history = history.map((one) => ({ ...one, state: all(one.state) }));
  state = all(state);
  curves = new Map();
}

// ---- what the tools do

function compare() {
  if (state.b) { state.a = changes(); state.b = null; state.side = "a"; state.names = ["A", "B"]; }
  else { state.b = { ...state.a }; state.a = {}; state.side = "b"; }
  keep();
  build();
  reflect();
  ask();
}

async function listTables() {
  const body = { file: state.file, changes: changes(), units: state.units, key: "" };
  const got = await post("/table", body);
  const now = $("table").value;
  $("table").replaceChildren(make("option", { value: "" }, "choose …"), ...got.tables.map(([key, heading]) => make("option", { value: key }, heading)));
  $("table").value = now;
}

let tabled = ""; // what the table below is of

async function showTable(signal) {
  const key = $("table").value, of = key + design();
  if (!key) { $("tabled").replaceChildren(); return; }
  try {
    const got = await post("/table", { file: state.file, changes: changes(), units: state.units, key }, signal);
    $("tabled").innerHTML = got.table;
  } catch (problem) {
    if (problem.name === "AbortError") throw problem;
    $("tabled").textContent = said(problem);
  }
  tabled = of;
  markStudies();
}

function listen() {
  $("undo").addEventListener("click", () => step(-1));
  $("redo").addEventListener("click", () => step(1));
  $("compare").addEventListener("click", compare);
  $("find").addEventListener("input", () => { showFields(); const aside = document.querySelector("aside"); aside.scrollTop = $("h-fields").offsetTop - 8; });
  $("copy").addEventListener("click", async () => { if (!navigator.clipboard) { getSelection().selectAllChildren($("command")); return; } await navigator.clipboard.writeText($("command").textContent); $("status").textContent = "Copied."; $("copy").textContent = "Copied"; setTimeout(() => { $("copy").textContent = "Copy"; }, 1500); });
  $("theme").addEventListener("click", () => {
    const dark = getComputedStyle(document.body).backgroundColor !== "rgb(255, 255, 255)";
    document.documentElement.dataset.theme = localStorage.theme = dark ? "light" : "dark";
  });
  for (const button of document.querySelectorAll("[data-save]")) button.addEventListener("click", () => save(button.dataset.save));
  $("target").addEventListener("input", showDifference);
  $("target").addEventListener("keydown", (event) => { if (event.key === "Enter") { event.preventDefault(); showDifference(); } }); // not the Cancel of its form
  $("replace").addEventListener("change", showDifference);
  $("dosave").addEventListener("click", doSave);
  $("table").addEventListener("focus", listTables, { once: false });
  $("table").addEventListener("change", () => restSoon(0));
  $("cancel").addEventListener("click", () => study && openStudy(study));
  $("upload").addEventListener("change", () => $("upload").files[0] && dropFile($("upload").files[0]));
  $("file").addEventListener("change", () => {
    const chosen = $("file").value;
    if (chosen === "open:") { $("upload").click(); $("file").value = state.file; }
    else if (chosen.startsWith("new:")) newSpec(chosen.slice(4));
    else if (chosen) openFile(fresh(chosen));
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") $("save").open = false;
    const typing = event.target.matches?.("input[type=text], input[type=search], #target");
    if (!(event.ctrlKey || event.metaKey)) return;
    const key = event.key.toLowerCase();
    if (key === "s") { event.preventDefault(); if (form && !$("saver").open) { document.activeElement.blur(); openSaver(); } } // what is being typed counts
    if (typing) return;
    if (key === "z" || key === "y") { event.preventDefault(); step(key === "y" || event.shiftKey ? 1 : -1); }
  });
  document.addEventListener("click", (event) => { if (!$("save").contains(event.target)) $("save").open = false; });
  document.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
  document.addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("dropping"); });
  document.addEventListener("drop", (event) => { event.preventDefault(); document.body.classList.remove("dropping"); if (event.dataTransfer.files[0]) dropFile(event.dataTransfer.files[0]); });
  window.addEventListener("focus", () => { if (form && !flying && !dragging && !study) ask(); }); // the file may have been changed meanwhile
  window.addEventListener("hashchange", () => { const read = readAddress(); if (!same(read, state) && read.file) openFile(read); });
  window.addEventListener("beforeprint", () => document.querySelectorAll("#answer details").forEach((one) => { one.wasOpen = one.open; one.open = true; }));
  window.addEventListener("afterprint", () => document.querySelectorAll("#answer details").forEach((one) => { one.open = one.wasOpen; }));
  setInterval(() => post("/files", {}).catch(() => {}), 300000); // the desk ends an hour after its last page
}

async function begin() {
  if (localStorage.theme) document.documentElement.dataset.theme = localStorage.theme;
  listen();
  try {
    about = await post("/files", {});
  } catch (problem) {
    showErrors(errorsOf(problem));
    return;
  }
  $("units").replaceChildren(...about.systems.map((name) => make("button", { type: "button", value: name, "aria-pressed": "false", onclick: () => { state.units = name; reflect(); ask(); } }, name)));
  const read = readAddress();
  if (about.files.includes(read.file)) await openFile(read);
  else if (about.files.length) await openFile(fresh(about.files[0]));
  else showStart();
}

begin();

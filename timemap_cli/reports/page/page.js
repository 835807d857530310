"use strict";
// The page of a result: everything it shows stands in the JSON above; nothing is fetched.
const DATA = JSON.parse(document.getElementById("data").textContent);
const UNKNOWN = 65535, CLEAR = 65534, PER_METRE = 100;
const LEVEL_COLOURS = ["#e69f00", "#56b4e9", "#222222", "#cc79a7", "#999933"];
const KIND_COLOURS = { appeared: "#009e73", vanished: "#d55e00", moved: "#0072b2" };
const CONFIG = { displaylogo: false, responsive: true, scrollZoom: true, modeBarButtonsToRemove: ["select2d", "lasso2d"] };
const EVENTS = DATA.changes.events;
const CHECK = DATA.check;  // a baseline and what is out of tolerance against it, if the result was checked
const BASELINE_COLOUR = "#d1004b";
const state = { step: DATA.times.length - 1, node: null, event: null, shown: {} };
const estimates = {};  // by level: {step, node, ranges}
const expected = {};  // the same of the baseline

const byId = (id) => document.getElementById(id);
// Nanoseconds since 1970 as text do not fit a number: the last six digits are left out for plotting.
const milliseconds = (ns) => Number(ns.slice(0, -6) || "0");
const iso = (ms) => new Date(ms).toISOString().replace("T", " ");
const readable = (ns) => iso(milliseconds(ns)).slice(0, 19);
const day = (ns) => readable(ns).slice(0, 16);
const colourOf = (level) => LEVEL_COLOURS[DATA.levels.indexOf(level) % LEVEL_COLOURS.length];
const holdsAt = (event, ns) => event.episodes.some(
  (one) => BigInt(one.since_ns) <= ns && (one.until_ns === null || ns < BigInt(one.until_ns)));

// Without WebGL (a remote desktop, say) points are drawn as SVG: slower, and the same to see.
const POINTS = document.createElement("canvas").getContext("webgl") ? "scattergl" : "scatter";

async function unpacked(base64) {
  const packed = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

async function rows(packed) {
  return {
    step: new Uint16Array(await unpacked(packed.step)),
    node: new Uint32Array(await unpacked(packed.node)),
    ranges: new Uint16Array(await unpacked(packed.ranges)),
  };
}

async function load() {
  for (const level of DATA.levels) estimates[level] = await rows(DATA.estimates[level]);
  if (!CHECK) return;
  for (const [level, packed] of Object.entries(CHECK.estimates)) expected[level] = await rows(packed);
}

// Row of the newest estimate of every node, up to a step.
function newest(level, step) {
  const { step: steps, node } = estimates[level], rows = new Map();
  for (let row = 0; row < steps.length && steps[row] <= step; row++) rows.set(node[row], row);
  return rows;
}

function endsOf(ranges, row, x0, y0, out) {
  const bins = DATA.angle_bins, turn = 2 * Math.PI / bins;
  for (let bin = 0; bin < bins; bin++) {
    const range = ranges[row * bins + bin];
    if (range >= CLEAR) continue;
    out.x.push(x0 + range / PER_METRE * Math.cos((bin + 0.5) * turn));
    out.y.push(y0 + range / PER_METRE * Math.sin((bin + 0.5) * turn));
  }
}

function pointsAt(level, step) {
  const out = { x: [], y: [] };
  for (const [node, row] of newest(level, step)) endsOf(estimates[level].ranges, row, ...DATA.nodes[node], out);
  return out;
}

// The baseline's ends of the levels that are ticked, under what the result holds.
function baselineTraces() {
  if (!CHECK) return [];
  const out = { x: [], y: [] };
  for (const level of Object.keys(expected).filter((one) => state.shown[one])) {
    CHECK.nodes.forEach(([x, y], row) => endsOf(expected[level].ranges, row, x, y, out));
  }
  const spots = CHECK.failures.flatMap((one) => (one.name.startsWith("ranges.places") ? one.spots : []));
  const rings = {
    type: "scatter", mode: "markers", name: "places", x: spots.map((s) => s.x), y: spots.map((s) => s.y), text: spots.map((s) => s.text),
    hoverinfo: "text", visible: state.shown.baseline,
    marker: { size: 34, symbol: "circle-open", color: BASELINE_COLOUR, line: { width: 2 } },
  };
  return [{ type: POINTS, mode: "markers", name: "baseline", hoverinfo: "skip", visible: state.shown.baseline,
    marker: { size: 4, color: BASELINE_COLOUR }, ...out }, rings];
}

function outlines(events) {
  const out = { x: [], y: [], customdata: [] };
  for (const event of events) {
    for (const [x, y] of [...event.outline, event.outline[0]]) {
      out.x.push(x); out.y.push(y); out.customdata.push(event.id);
    }
    out.x.push(null); out.y.push(null); out.customdata.push(event.id);
  }
  return out;
}

// A number stands on that side of its mark that looks away from the nearest other one.
function labelSides(marks) {
  const around = ["middle right", "top right", "top center", "top left", "middle left", "bottom left", "bottom center", "bottom right"];
  return marks.map((mark) => {
    const offsets = marks.filter((one) => one !== mark).map((one) => [mark.x - one.x, mark.y - one.y]);
    if (!offsets.length) return "top center";
    const [dx, dy] = offsets.reduce((best, one) => (Math.hypot(...one) < Math.hypot(...best) ? one : best));
    return around[(Math.round(Math.atan2(dy, dx) / (Math.PI / 4)) + 8) % 8];
  });
}

function planTraces() {
  const now = BigInt(DATA.times[state.step] ?? "0");
  const levels = [...DATA.levels].reverse().map((level) => ({
    type: POINTS, mode: "markers", name: level, hoverinfo: "skip", visible: state.shown[level],
    marker: { size: 2.5, color: colourOf(level) }, ...pointsAt(level, state.step),
  }));
  const nodes = {
    type: "scatter", mode: "markers", name: "nodes", x: DATA.nodes.map((n) => n[0]), y: DATA.nodes.map((n) => n[1]),
    text: DATA.nodes.map((_, i) => `node ${i}`), customdata: DATA.nodes.map((_, i) => ({ node: i })), hoverinfo: "text",
    marker: { size: DATA.nodes.map((_, i) => (i === state.node ? 12 : 6)), color: "#2a9d5c", line: { width: 1, color: "#fff" } },
  };
  const kinds = Object.entries(KIND_COLOURS).map(([kind, colour]) => ({
    type: "scatter", mode: "lines", name: kind, fill: "toself", fillcolor: colour + "55", line: { color: colour, width: 2 },
    hoverinfo: "skip", ...outlines(EVENTS.filter((e) => e.kind === kind && holdsAt(e, now))),
  }));
  const marks = EVENTS.filter((e) => holdsAt(e, now)), sides = labelSides(marks);
  const handles = {
    type: "scatter", mode: "markers+text", name: "events", x: marks.map((e) => e.x), y: marks.map((e) => e.y),
    text: marks.map((e) => String(e.id)), textposition: sides,
    textfont: { size: 13, color: "#1c2530", shadow: "0 0 2px #fff, 0 0 3px #fff, 0 0 4px #fff, 0 0 4px #fff" },
    hovertext: marks.map((e) => `${e.id} ${e.kind} since ${readable(e.first_seen_ns)}`), hoverinfo: "text",
    customdata: marks.map((e) => ({ event: e.id })), marker: { size: 8, color: marks.map((e) => KIND_COLOURS[e.kind]), line: { width: 1, color: "#fff" } },
  };
  const chosen = EVENTS.filter((e) => e.id === state.event);
  const halo = {
    type: "scatter", mode: "lines", name: "chosen", hoverinfo: "skip", line: { color: "#f5b700", width: 5 }, ...outlines(chosen),
  };
  return [...baselineTraces(), ...levels, nodes, halo, ...kinds, handles];
}

// Times in which nothing was recorded are left out of the time line, if they are longer than an hour.
function pauses(times) {
  const found = [];
  for (let i = 1; i < times.length; i++) {
    if (times[i] - times[i - 1] > 3.6e6) found.push({ bounds: [iso(times[i - 1] + 6e4), iso(times[i] - 6e4)] });
  }
  return found;
}

// Where there are pauses, the line names the times at which recording went on, at most ten of them.
function timeAxis() {
  const times = DATA.times.map(milliseconds), first = times[0], last = times[times.length - 1];
  const room = Math.max(1000, (last - first) * 0.01), left = pauses(times);
  if (!left.length) return { type: "date", range: [iso(first - room), iso(last + room)], ...AXES };
  const begins = times.filter((time, i) => i === 0 || time - times[i - 1] > 3.6e6);
  const every = Math.ceil(begins.length / 10), told = begins.filter((_, i) => i % every === 0);
  return { type: "date", range: [iso(first - 2e4), iso(last + 2e4)], rangebreaks: left, ...AXES, gridcolor: "#c5cdd8",
    tickvals: told.map(iso), ticktext: told.map((time) => iso(time).slice(0, 16).replace(" ", "<br>")) };
}

// The numbers of the time line's rows, at most fifteen of them.
function rowTicks() {
  const every = Math.ceil(EVENTS.length / 15), rows = EVENTS.map((_, i) => i).filter((i) => i % every === 0);
  return { tickvals: rows, ticktext: rows.map((i) => String(EVENTS[i].id)) };
}

const AXES = { zeroline: false, gridcolor: "#eef1f5" };

function drawPlan() {
  const layout = {
    margin: { l: 44, r: 8, t: 8, b: 36 }, showlegend: false, dragmode: "pan", uirevision: "keep", hovermode: "closest",
    xaxis: { title: { text: "x [m]" }, ...AXES }, yaxis: { title: { text: "y [m]" }, scaleanchor: "x", ...AXES },
  };
  Plotly.react("plan", planTraces(), layout, CONFIG);
  byId("now").textContent = DATA.times.length ? readable(DATA.times[state.step]) + " UTC" : "no estimates";
}

function drawLine() {
  byId("line-box").hidden = EVENTS.length === 0;
  if (!EVENTS.length) return;
  const end = DATA.times[DATA.times.length - 1];
  const traces = Object.entries(KIND_COLOURS).map(([kind, colour]) => {
    const x = [], y = [], customdata = [];
    EVENTS.filter((e) => e.kind === kind).forEach((event) => event.episodes.forEach((one) => {
      x.push(milliseconds(one.since_ns), milliseconds(one.until_ns ?? end), null);
      const row = EVENTS.indexOf(event);
      y.push(row, row, null);
      customdata.push({ event: event.id }, { event: event.id }, null);
    }));
    return { type: "scatter", mode: "lines+markers", name: kind, x, y, customdata, line: { color: colour, width: 7 },
      marker: { size: 7, color: colour }, hoverinfo: "none" };  // "skip" would pass over clicks, too
  });
  const now = DATA.times.length ? milliseconds(DATA.times[state.step]) : 0;
  Plotly.react("line", traces, {
    height: Math.min(420, 110 + 22 * EVENTS.length), margin: { l: 44, r: 24, t: 30, b: 40 }, showlegend: false,
    hovermode: "y", uirevision: "keep", xaxis: timeAxis(),  // a click counts anywhere in a row
    yaxis: { ...rowTicks(), title: { text: "id" },
      range: [EVENTS.length - 0.4, -0.6], ...AXES },
    shapes: [{ type: "line", x0: now, x1: now, y0: 0, y1: 1, yref: "paper", line: { color: "#888", width: 1, dash: "dot" } }],
  }, CONFIG);
}

function drawNode() {
  if (state.node === null) return;
  const traces = [...DATA.levels].reverse().map((level, place) => {
    const out = { x: [], y: [] }, row = newest(level, state.step).get(state.node);
    if (row !== undefined) endsOf(estimates[level].ranges, row, 0, 0, out);
    return { type: "scatter", mode: "markers", name: level, hoverinfo: "skip",
      marker: { size: 9 - 3 * Math.min(place, 2), color: colourOf(level) }, ...out };
  });
  traces.push({ type: "scatter", mode: "markers", x: [0], y: [0], hoverinfo: "skip", marker: { size: 8, color: "#2a9d5c" }, showlegend: false });
  byId("node-title").textContent = `Node ${state.node}: what each level holds`;
  Plotly.react("node", traces, {
    margin: { l: 40, r: 8, t: 8, b: 32 }, legend: { orientation: "h", y: 1.12 }, uirevision: String(state.node),
    xaxis: { title: { text: "m" }, ...AXES }, yaxis: { scaleanchor: "x", ...AXES },
  }, CONFIG);
}

function fillEvents() {
  const head = byId("events").tHead, body = byId("events").tBodies[0];
  head.innerHTML = "<tr><th>id</th><th>what</th><th>x, y [m]</th><th>since</th><th>until</th><th>adopted by</th><th title=\"share of the looks at it in which it held\">held</th></tr>";
  if (!EVENTS.length) {
    const cell = body.insertRow().insertCell();
    cell.colSpan = 7;
    cell.append("No change was found.");
  }
  for (const event of EVENTS) {
    const row = body.insertRow();
    row.dataset.event = event.id;
    const levels = Object.entries(event.adopted).filter(([, at]) => at !== null).map(([level]) => level).join(", ");
    const until = event.closed_ns === null ? (event.not_seen_since ? "not looked at since" : "") : day(event.closed_ns);
    const what = event.kind + (event.recurring ? ` (${event.episodes.length}×)` : "");
    const cells = [event.id, what, `${event.x.toFixed(2)}, ${event.y.toFixed(2)}`, day(event.first_seen_ns), until, levels,
      `${Math.round(event.share_held * 100)} %`];
    cells.forEach((text, column) => {
      const cell = row.insertCell();
      if (column === 1) {
        const swatch = document.createElement("span");
        swatch.className = "swatch"; swatch.style.background = KIND_COLOURS[event.kind];
        cell.append(swatch);
      }
      if (column >= 3 && column <= 5) cell.append(...words(text));
      else cell.append(String(text));
    });
    row.addEventListener("click", () => choose(event.id));
  }
}

// Words that a line may be broken between, and nowhere within: a date stays whole.
function words(text) {
  return text.split(" ").flatMap((word) => {
    const whole = document.createElement("span");
    whole.className = "whole";
    whole.append(word);
    return [whole, " "];
  });
}

function choose(id) {
  const event = EVENTS.find((one) => one.id === id);
  state.event = id;
  state.node = event.nodes[0] ?? event.against[0] ?? state.node;
  draw();
  const [x0, y0, x1, y1] = event.bounds, room = 3;
  Plotly.relayout("plan", { "xaxis.range": [x0 - room, x1 + room], "yaxis.range": [y0 - room, y1 + room] });
}

function markRows() {
  const now = BigInt(DATA.times[state.step] ?? "0");
  for (const row of byId("events").tBodies[0].querySelectorAll("[data-event]")) {
    const event = EVENTS.find((one) => String(one.id) === row.dataset.event);
    row.classList.toggle("chosen", event.id === state.event);
    row.classList.toggle("past", !holdsAt(event, now));
  }
}

function fillTable(id, rows) {
  for (const [name, value] of rows) {
    const row = byId(id).insertRow();
    row.insertCell().append(name);
    row.insertCell().append(String(value));
  }
}

const counted = (number, word) => `${number} ${word}${number === 1 ? "" : "s"}`;

function fillRest() {
  const { scans } = DATA.report, summary = DATA.changes.summary;
  byId("told").textContent = `${counted(EVENTS.length, "change")}, of which ${summary.open ?? 0} still hold; ` +
    `${counted(DATA.nodes.length, "node")}; ${scans.used} of ${scans.read} scans used`;
  fillTable("scans", [["read", scans.read], ["used", scans.used], ...Object.entries(scans.dropped)]);
  fillTable("inputs", DATA.inputs.map((one) => [one.name, one.sha256]));
  fillTable("made", DATA.made);
  byId("settings").textContent = DATA.settings;
  Plotly.newPlot("coverage", DATA.levels.map((level) => ({
    type: "bar", name: level, x: DATA.coverage.nodes, y: DATA.coverage[level], marker: { color: colourOf(level) },
    hovertemplate: "node %{x}: %{y}<extra>" + level + "</extra>",
  })), { margin: { l: 44, r: 8, t: 8, b: 36 }, barmode: "group", legend: { orientation: "h", y: 1.2 },
    xaxis: { title: { text: "node" } }, yaxis: { title: { text: "angle bins" }, range: [0, DATA.angle_bins] } }, CONFIG);
}

function fillLevels() {
  for (const level of DATA.levels) {
    state.shown[level] = level === DATA.levels[DATA.levels.length - 1] || DATA.levels.length === 1;
    const label = document.createElement("label"), box = document.createElement("input"), swatch = document.createElement("span");
    box.type = "checkbox"; box.checked = state.shown[level]; box.id = `level-${level}`;
    box.addEventListener("change", () => { state.shown[level] = box.checked; drawPlan(); });
    swatch.className = "swatch"; swatch.style.background = colourOf(level);
    label.append(box, swatch, level, " ");
    byId("levels").append(label);
  }
  for (const [kind, colour] of Object.entries(KIND_COLOURS)) {
    const label = document.createElement("span"), swatch = document.createElement("span");
    swatch.className = "swatch"; swatch.style.background = colour;
    label.append(swatch, kind);
    byId("kinds").append(label);
  }
}

function fillCheck() {
  if (!CHECK) return;
  state.shown.baseline = true;
  const label = document.createElement("label"), box = document.createElement("input"), swatch = document.createElement("span");
  box.type = "checkbox"; box.checked = true; box.id = "baseline";
  box.addEventListener("change", () => { state.shown.baseline = box.checked; drawPlan(); });
  swatch.className = "swatch"; swatch.style.background = BASELINE_COLOUR;
  label.append(box, swatch, "baseline");
  byId("levels").append(label);
  byId("check-box").hidden = false;
  byId("check-title").textContent = `Check against ${CHECK.baseline}: ${CHECK.outcome}, ` +
    `${CHECK.failures.length} of ${counted(CHECK.figures, "figure")} out of tolerance`;
  byId("causes").textContent = [...CHECK.causes.map((one) => `likely: ${one}`), ...CHECK.notes].join("\n");
  if (CHECK.failures.length) byId("failures").tHead.innerHTML = "<tr><th>figure</th><th>is</th><th>allowed</th><th>what, where</th></tr>";
  for (const one of CHECK.failures) {
    fillFailure([one.name, one.value, one.allowed, one.text], one.spots[0]);
    for (const spot of one.spots) fillFailure(["", "", "", `${spot.x.toFixed(2)}, ${spot.y.toFixed(2)}: ${spot.text}`], spot);
  }
}

function fillFailure(cells, spot) {
  const row = byId("failures").tBodies[0].insertRow();
  for (const text of cells) row.insertCell().append(text);
  if (!spot) return;
  row.className = "placed";
  row.addEventListener("click", () => {
    if (spot.nodes.length && spot.nodes[0] < DATA.nodes.length) state.node = spot.nodes[0];
    draw();
    Plotly.relayout("plan", { "xaxis.range": [spot.x - 2, spot.x + 2], "yaxis.range": [spot.y - 2, spot.y + 2] });
  });
}

function draw() { drawPlan(); drawLine(); drawNode(); markRows(); }

// Of the points that a click met, the one whose place is nearest to it from top to bottom.
function nearestRow(points, y) {
  const apart = (one) => Math.abs(one.yaxis._offset + one.yaxis.d2p(one.y) - y);
  return points.reduce((best, one) => (apart(one) < apart(best) ? one : best));
}

function clicked(target) {
  byId(target).on("plotly_click", (found) => {
    const data = nearestRow(found.points, found.event.clientY - byId(target).getBoundingClientRect().top).customdata;
    if (data && data.event !== undefined) choose(data.event);
    if (data && data.node !== undefined) { state.node = data.node; draw(); }
  });
}

async function start() {
  await load();
  fillLevels(); fillCheck(); fillEvents(); fillRest();
  const slider = byId("time");
  slider.max = Math.max(0, DATA.times.length - 1);
  slider.value = slider.max;
  slider.addEventListener("input", () => { state.step = Number(slider.value); draw(); });
  if (DATA.nodes.length) state.node = 0;
  draw();
  clicked("plan");
  if (EVENTS.length) clicked("line");
  document.body.dataset.ready = "yes";
}

start();

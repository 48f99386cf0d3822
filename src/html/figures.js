// The figures of a page: every number is one of the report's, and carries its place there.
"use strict";
const report = JSON.parse(document.getElementById("report").textContent);

function element(name, attributes, ...children) {
  const own = document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) own.setAttribute(key, value);
  own.append(...children);
  return own;
}

/** What the report has at a JSON pointer. */
function at(pointer) {
  return pointer.split("/").slice(1).reduce((own, key) => (own == null ? own : own[key]), report);
}

/** A number as people read it. */
function figure(x) {
  if (x === null || x === undefined) return "–";
  if (typeof x !== "number" || Number.isInteger(x)) return String(x);
  const size = Math.abs(x);
  return size >= 1e-3 && size < 1e5 ? x.toPrecision(5).replace(/\.?0+$/, "") : x.toExponential(3);
}

/** A value of the report as it stands there, rounded to be read. */
function value(pointer, tag = "td") {
  const own = at(pointer);
  const shown = Array.isArray(own) ? own.map(figure).join(", ") : figure(own);
  const cell = element(tag, { "data-pointer": pointer, "data-value": JSON.stringify(own ?? null), title: JSON.stringify(own ?? null) }, shown);
  if (typeof own === "string" || Array.isArray(own)) cell.className = "text";
  return cell;
}

/** A table of the objects in a list of the report, by their keys. */
function table(pointer, columns, limit = 200) {
  const rows = (at(pointer) || []).slice(0, limit);
  if (rows.length === 0) return element("p", { class: "small" }, "none");
  const head = element("tr", {}, ...columns.map(([, title]) => element("th", {}, title)));
  const body = rows.map((_, n) => element("tr", {}, ...columns.map(([key]) => value(`${pointer}/${n}/${key}`))));
  const box = element("div", { class: "scroll" }, element("table", {}, head, ...body));
  const more = at(pointer).length - rows.length;
  if (more > 0) box.append(element("p", { class: "small" }, `and ${more} more in the JSON report`));
  return box;
}

function chapter(title, ...children) {
  const own = element("section", {}, element("h2", {}, title), ...children);
  document.getElementById("figures").append(own);
}

/** The verdict in a sentence, and what it is worth. */
function verdict() {
  const bound = at("/certificate/j_over_jc/lower");
  const failed = (report.certificate.worst || []).filter((own) => own.verdict !== "valid").length;
  const off = (report.off_cad || []).length + (report.open_faces || []).length;
  const folds = report.walls ? report.walls.faces - report.walls.valid : 0;
  if (!report.certified) return ["bad", `NOT certified: ${failed} elements are not proven valid.`];
  if (folds > 0) return ["bad", `Every element is proven valid, but ${folds} wall faces are not proven free of folds.`];
  const proven = `Every element is proven valid, with J/J_c of at least ${figure(bound)} everywhere`;
  if (off > 0) return ["partly", `${proven}, but ${off} boundary faces that belong to the CAD are not on it.`];
  const patches = (report.patches || []).filter((own) => own.cad_distance_max !== null);
  const farthest = patches.reduce((most, own) => (most && most.cad_distance_max >= own.cad_distance_max ? most : own), null);
  const unit = report.input && report.input.cad_scale === 1 ? ` ${report.input.cad_unit}` : "";
  const distance = farthest && `; its walls are within ${figure(farthest.cad_distance_max)}${unit} of the CAD (farthest: ${[...farthest.names, farthest.entity].join(", ")})`;
  return ["good", proven + (distance || "") + "."];
}

function histogram(own) {
  const { from, to, counts } = own.histogram;
  const [width, height] = [260, 70];
  const most = Math.max(...counts, 1);
  const bars = counts.map((count, n) => {
    const tall = count === 0 ? 0 : Math.max(1, (Math.log1p(count) / Math.log1p(most)) * height);
    const [x, wide] = [(n * width) / counts.length, width / counts.length - 0.6];
    const [low, high] = [n, n + 1].map((k) => from + ((to - from) * k) / counts.length);
    return `<rect x="${x}" y="${height - tall + 4}" width="${wide}" height="${tall}" fill="#31688e"><title>${figure(low)} to ${figure(high)}: ${count}</title></rect>`;
  });
  const drawing = element("div");
  drawing.innerHTML = `<svg width="${width}" height="${height + 18}" role="img">${bars.join("")}<text x="0" y="${height + 16}">${figure(from)}</text><text x="${width}" y="${height + 16}" text-anchor="end">${figure(to)}</text></svg>`;
  return element("div", {}, element("h3", {}, `${own.cell}: ${own.measure}`), drawing);
}

function measures() {
  const all = report.measures || [];
  if (all.length === 0) return;
  const percents = all[0].percentiles.map((own) => own.percent);
  const titles = ["cell", "measure", "elements", "no value", "mean", ...percents.map((p) => (p === 0 ? "least" : p === 100 ? "largest" : `${p} %`))];
  const row = (own, n) => element("tr", {}, ...["cell", "measure", "count", "unknown", "mean"].map((key) => value(`/measures/${n}/${key}`)),
    ...own.percentiles.map((_, k) => value(`/measures/${n}/percentiles/${k}/value`)));
  const head = element("tr", {}, ...titles.map((title) => element("th", {}, title)));
  chapter("Measures of the elements",
    element("p", { class: "small" }, "Values that so many percent of the elements do not exceed. J/J_c and scaled Jacobian: a proven lower bound of every element; C_WCN and C_JAC: worst of a survey. Bars by the logarithm of the count."),
    element("div", { class: "scroll" }, element("table", {}, head, ...all.map(row))),
    element("div", { class: "charts" }, ...all.map(histogram)));
}

function plain(pointer) {
  const cell = value(pointer);
  cell.className = "text";
  return cell;
}

function given() {
  const rows = [["/run/date", "date (UTC)"], ["/run/command", "command"], ["/run/exit_code", "exit code"], ["/run/reason", "which means"], ["/version", "sagitta"], ["/input/mesh", "mesh"], ["/mesh", "mesh"],
    ["/input/cad", "CAD"], ["/input/cad_unit", "unit of the CAD"], ["/input/cad_scale", "CAD multiplied by"], ["/input/linkage", "linkage"],
    ["/order", "order"], ["/nodes/linear", "nodes of the linear mesh"], ["/nodes/curved", "nodes"], ["/threads", "threads"], ["/peak_memory", "peak memory, bytes"]];
  const shown = rows.filter(([pointer]) => at(pointer) !== undefined && at(pointer) !== null);
  const command = (pointer) => element("td", { class: "text", "data-pointer": pointer, "data-value": JSON.stringify(at(pointer)) }, element("code", {}, at(pointer).join(" ")));
  chapter("What was given", element("table", {}, ...shown.map(([pointer, title]) =>
    element("tr", {}, element("th", {}, title), pointer === "/run/command" ? command(pointer) : plain(pointer)))));
}

function curving() {
  if (!report.patches) return;
  chapter("Patches: what lies on which CAD, and how far from it", table("/patches", [["entity", "entity"], ["names", "names"], ["cad_groups", "on the CAD"], ["faces", "faces"],
    ["cad_distance_max", "largest distance"], ["cad_distance_at", "its place"], ["cad_distance_rms", "root mean square"], ["node_move_max", "largest move of a linear node"]]),
    element("p", { class: "small" }, "Lengths in the mesh's unit; distances at (3p)² samples a face."));
  chapter("Boundary faces off the CAD", element("h3", {}, "taken back or released for valid elements"),
    table("/off_cad", [["element", "face"], ["entity", "entity"], ["cad_distance", "distance"], ["position", "place"]]),
    element("h3", {}, "straight, as it could not be decided what they lie on"),
    table("/open_faces", [["element", "face"], ["entity", "entity"], ["cause", "cause"], ["remedy", "remedy"], ["position", "place"]]));
  const costs = (where) => ["c_wcn", "c_jac", "inverted"].map((key) => value(`${where}/${key}`));
  const head = ["order", "sweeps", "C_WCN before", "C_JAC before", "inverted before", "C_WCN after", "C_JAC after", "inverted after"];
  const row = (order, where) => element("tr", {}, order, value(`${where}/sweeps`), ...costs(`${where}/start`), ...costs(`${where}/end`));
  chapter("Smoothing: smallest costs", element("table", {}, element("tr", {}, ...head.map((title) => element("th", {}, title))),
    ...report.smoothing.lower_orders.map((_, n) => row(value(`/smoothing/lower_orders/${n}/order`), `/smoothing/lower_orders/${n}`)),
    row(value("/order"), "/smoothing")), convergence());
  chapter("Grid lines off the walls: angles in degrees", element("table", {}, element("tr", {}, ...["mesh", "lines", "angles", "99 % are at most", "largest"].map((title) => element("th", {}, title))),
    ...["curved", "linear"].map((which) => element("tr", {}, element("td", {}, which), ...["lines", "angles", "p99", "max"].map((key) => value(`/grid_line_angles/${which}/${key}`))))));
  chapter("Seconds a step", table("/seconds", [["step", "step"], ["seconds", "seconds"]]));
}

/** The smallest costs over the sweeps of all orders, where they were followed. */
function convergence() {
  const all = report.sweeps || [];
  if (all.length < 2) return element("span");
  const [width, height] = [560, 130];
  const costs = all.flatMap((own) => [own.c_wcn, own.c_jac]);
  const [low, high] = [Math.min(...costs), Math.max(...costs)];
  const x = (n) => (n / (all.length - 1)) * width;
  const y = (cost) => 6 + (1 - (cost - low) / (high - low || 1)) * height;
  const line = (key, colour) => `<polyline fill="none" stroke="${colour}" stroke-width="1.5" points="${all.map((own, n) => `${x(n).toFixed(1)},${y(own[key]).toFixed(1)}`).join(" ")}"/>`;
  const orders = all.flatMap((own, n) => (n === 0 || own.order !== all[n - 1].order ? [`<line x1="${x(n)}" x2="${x(n)}" y1="6" y2="${height + 6}" stroke="#c3c9d1"/><text x="${x(n) + 3}" y="15">P${own.order}</text>`] : []));
  const own = element("div");
  own.innerHTML = `<svg width="${width + 60}" height="${height + 28}" role="img">${orders.join("")}${line("c_wcn", "#31688e")}${line("c_jac", "#d1495b")}<text x="${width + 4}" y="12">${figure(high)}</text><text x="${width + 4}" y="${height + 6}">${figure(low)}</text><text x="0" y="${height + 22}">smallest C_WCN (blue) and C_JAC (red) over ${all.length} sweeps</text></svg>`;
  return own;
}

function tell() {
  const [kind, sentence] = verdict();
  const title = document.getElementById("verdict");
  title.className = kind;
  title.textContent = sentence;
  const counts = (report.cells || []).map((own) => `${own.count} ${own.cell}`).join(", ");
  const mesh = report.mesh || (report.input && report.input.mesh);
  document.title = `sagitta: ${mesh}`;
  document.getElementById("subject").textContent = `${mesh}: P${report.order}, ${counts}`;
  chapter("Certificate", element("table", {}, ...[["j_over_jc", "smallest J/J_c"], ["scaled_jacobian", "smallest scaled Jacobian"]].map(([key, title]) =>
    element("tr", {}, element("th", {}, title), element("td", {}, "proven"), value(`/certificate/${key}/lower`), element("td", {}, "attained"), value(`/certificate/${key}/upper`)))),
    element("h3", {}, "elements not proven valid, and the weakest"),
    table("/certificate/worst", [["element", "element"], ["cell", "cell"], ["verdict", "verdict"], ["j_over_jc/lower", "J/J_c proven"], ["j_over_jc/upper", "attained"], ["position", "place of its smallest Jacobian"]]));
  measures();
  curving();
  chapter("Notes", ...((report.notes || []).length ? report.notes.map((note) => element("p", {}, note)) : [element("p", { class: "small" }, "none")]));
  given();
}
tell();

// The mesh in space.
"use strict";
const geometry = JSON.parse(document.getElementById("geometry").textContent);
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
const nodes = new Float32Array(bytes(geometry.nodes));
const origin = geometry.origin;
const by = (id) => document.getElementById(id);

/** A block of the page with its numbers as arrays. */
function decoded(block) {
  const values = {};
  for (const [name, text] of Object.entries(block.values)) values[name] = new Float32Array(bytes(text));
  return { ...block, values, connectivity: new Uint32Array(bytes(block.connectivity)), patch: new Uint32Array(bytes(block.patch)),
    number: new Float64Array(bytes(block.number)), curved: new Uint8Array(bytes(block.curved)) };
}
const faces = geometry.faces.map(decoded);
const elements = geometry.elements.map(decoded);
const pool = geometry.flat ? faces : elements;

/** Points of the filling of an item, into an array. */
function filled(block, item, into, start) {
  const { weights } = block.fillings[block.curved[item]];
  const count = weights.length / block.stride;
  for (let point = 0; point < count; point++) {
    let [x, y, z] = [0, 0, 0];
    for (let n = 0; n < block.stride; n++) {
      const weight = weights[point * block.stride + n];
      if (weight === 0) continue;
      const node = 3 * block.connectivity[item * block.stride + n];
      x += weight * nodes[node]; y += weight * nodes[node + 1]; z += weight * nodes[node + 2];
    }
    into[start + 3 * point] = x; into[start + 3 * point + 1] = y; into[start + 3 * point + 2] = z;
  }
  return count;
}

// ---- colours

function viridis(t) {
  const c = [[0.2777, 0.0054, 0.3341], [0.1051, 1.4046, 1.3846], [-0.3309, 0.2148, 0.0951], [-4.6342, -5.7991, -19.3324], [6.2283, 14.1799, 56.6906], [4.7764, -13.7451, -65.353], [-5.4355, 4.6459, 26.3124]];
  const s = Math.min(1, Math.max(0, t));
  return [0, 1, 2].map((k) => Math.min(1, Math.max(0, c.reduceRight((sum, own) => sum * s + own[k], 0))));
}
const ofPatch = (place) => {
  const own = new THREE.Color().setHSL((0.55 + place * 0.618034) % 1, 0.55, [0.6, 0.7, 0.5][place % 3]);
  return own.getRGB({}, "srgb");
};
const WRONG = [0.95, 0.1, 0.75], NONE = [0.78, 0.79, 0.81];
const linear = (rgb) => { const own = new THREE.Color().setRGB(...rgb, "srgb"); return [own.r, own.g, own.b]; };
let paint = null;

/** What a colouring says: a colour of a block's item, and the ends of its scale. */
function painter(name) {
  if (name === "patch") return { of: (block, item) => { const { r, g, b } = ofPatch(block.patch[item] || 0); return linear([r, g, b]); } };
  const all = [...faces, ...elements].filter((block) => block.values[name]).flatMap((block) => [block.values[name]]);
  const length = name === "distance to CAD";
  let [low, high] = [1, length ? 0 : 1];
  for (const values of all) for (const value of values) {
    if (!Number.isFinite(value)) continue;
    if (length) high = Math.max(high, value); else if (value > 0) low = Math.min(low, value);
  }
  if (length) low = 1e-3 * high; else if (low >= 0.999) low = 0;
  const part = (value) => (length ? (high > 0 ? Math.log(Math.max(value / low, 1)) / Math.log(high / low) : 0) : (value - low) / (1 - low));
  const of = (block, item) => {
    const value = block.values[name] ? block.values[name][item] : NaN;
    if (!length && (value <= 0)) return linear(WRONG);
    return linear(Number.isFinite(value) ? viridis(part(value)) : NONE);
  };
  return { of, low, high: length ? high : 1, logarithmic: length };
}

function showScale(name) {
  const box = by("scale");
  box.textContent = "";
  if (name === "patch") return;
  const stops = [0, 0.25, 0.5, 0.75, 1].map((t) => `rgb(${viridis(t).map((x) => Math.round(255 * x)).join(",")})`);
  box.append(element("div", {}, name + (paint.logarithmic ? " (logarithmic)" : "")), element("div", { class: "bar", style: `background:linear-gradient(to right,${stops.join(",")})` }),
    element("div", { class: "ends" }, element("span", {}, figure(paint.low)), element("span", {}, figure(paint.high))));
  if (!paint.logarithmic) box.append(element("div", {}, element("span", { class: "swatch", style: "background:#f21abf" }), "0 or less"));
}

// ---- the scene

const canvas = by("view");
const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
renderer.setClearColor(0xffffff);
renderer.localClippingEnabled = true;
const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(35, 1, 0.1, 1000);
camera.up.set(0, 0, 1);
const light = new THREE.DirectionalLight(0xffffff, 1.7);
light.position.set(-0.3, 0.45, 1);
camera.add(light);
scene.add(camera, new THREE.AmbientLight(0xffffff, 1.5));
const controls = new THREE.TrackballControls(camera, canvas);
controls.rotateSpeed = 3; controls.staticMoving = true;
const plane = new THREE.Plane(new THREE.Vector3(0, 0, -1), 0);
let clipping = [];
const surfaceMaterial = new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
const edgeMaterial = new THREE.LineBasicMaterial({ color: 0x1e2127, transparent: true, opacity: 0.55 });
const sectionMaterial = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
const hidden = new Set(geometry.patches.flatMap((own, place) => (own.outer ? [place] : [])));
const walls = new THREE.Group(), cutting = new THREE.Group(), marking = new THREE.Group();
scene.add(walls, cutting, marking);

/** A surface of items of a block, and their edges. */
function surface(block, items, material = surfaceMaterial, outer = false) {
  const count = (item) => block.fillings[block.curved[item]].weights.length / block.stride;
  const points = items.reduce((sum, item) => sum + count(item), 0);
  const positions = new Float32Array(3 * points), colours = new Float32Array(3 * points), index = [], edges = [];
  let first = 0;
  for (const item of items) {
    const { simplices, outside } = block.fillings[block.curved[item]];
    const own = filled(block, item, positions, 3 * first);
    const corners = geometry.flat || !outer ? 3 : 4; // of a simplex: of faces, or of volumes
    for (let s = 0; s < simplices.length; s += corners) {
      for (let q = 0; q < corners; q++) {
        const others = [...Array(corners).keys()].filter((k) => k !== q).map((k) => first + simplices[s + k]);
        if (corners === 3 && outside[s + q]) edges.push(...others);
        if (corners === 4 && outside[s + q]) index.push(...others);
      }
      if (corners === 3) index.push(first + simplices[s], first + simplices[s + 1], first + simplices[s + 2]);
    }
    first += own;
  }
  const shape = new THREE.BufferGeometry();
  shape.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  shape.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  shape.setIndex(index);
  shape.computeVertexNormals();
  const mesh = new THREE.Mesh(shape, material);
  mesh.userData = { block, items, count };
  const lines = new THREE.BufferGeometry();
  lines.setAttribute("position", shape.getAttribute("position"));
  lines.setIndex(edges);
  return [mesh, new THREE.LineSegments(lines, edgeMaterial)];
}

function colour(mesh) {
  const { block, items, count } = mesh.userData;
  const colours = mesh.geometry.getAttribute("color");
  let at = 0;
  for (const item of items) {
    const own = paint.of(block, item);
    for (let k = count(item); k > 0; k--) { colours.setXYZ(at, ...own); at += 1; }
  }
  colours.needsUpdate = true;
}

function build() {
  for (const block of faces) {
    const patches = new Map();
    for (let item = 0; item < block.count; item++) {
      if (!patches.has(block.patch[item])) patches.set(block.patch[item], []);
      patches.get(block.patch[item]).push(item);
    }
    for (const [patch, items] of patches) {
      const [mesh, lines] = surface(block, items);
      mesh.userData.patch = patch; lines.userData.patch = patch;
      walls.add(mesh, lines);
    }
  }
}

function refresh() {
  for (const own of walls.children) {
    own.visible = !hidden.has(own.userData.patch) && (!own.isLineSegments || by("edges").checked);
    if (own.isMesh) colour(own);
  }
  draw();
}

/** The corners of the box of what is shown. */
function box(all) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const block of faces) for (let item = 0; item < block.count; item++) {
    if (!all && hidden.has(block.patch[item])) continue;
    for (let n = 0; n < block.stride; n++) for (let k = 0; k < 3; k++) {
      const x = nodes[3 * block.connectivity[item * block.stride + n] + k];
      low[k] = Math.min(low[k], x); high[k] = Math.max(high[k], x);
    }
  }
  return low[0] <= high[0] ? [low, high] : box(true);
}

/** Looks at a place from a distance, from where the eye is now or from a direction. */
function look(place, distance, from) {
  const target = new THREE.Vector3(...place);
  const direction = from ? new THREE.Vector3(...from).normalize() : camera.position.clone().sub(controls.target).normalize();
  controls.target.copy(target);
  camera.position.copy(target).addScaledVector(direction, distance);
  controls.update();
  draw();
}

function whole() {
  const [low, high] = box(false);
  const middle = low.map((x, k) => (x + high[k]) / 2);
  const size = Math.hypot(...low.map((x, k) => high[k] - x));
  if (geometry.flat) camera.up.set(0, 1, 0); else camera.up.set(0, 0, 1);
  look(middle, 1.55 * size, geometry.flat ? [0, 0, 1] : [-0.62, -0.9, 0.62]);
}

function draw() {
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  renderer.setSize(width, height, false);
  camera.aspect = width / Math.max(height, 1);
  const distance = camera.position.distanceTo(controls.target);
  camera.near = distance * 0.02;
  camera.far = distance * 50 + 4 * radius;
  camera.updateProjectionMatrix();
  renderer.render(scene, camera);
}
const radius = (() => { const [low, high] = box(true); return Math.hypot(...low.map((x, k) => high[k] - x)); })();

// ---- the plane that cuts

/** Lower and upper ends of each element along the axes. */
const spans = elements.map((block) => {
  const span = new Float32Array(6 * block.count);
  for (let item = 0; item < block.count; item++) for (let k = 0; k < 3; k++) {
    let [low, high] = [Infinity, -Infinity];
    for (let n = 0; n < block.stride; n++) {
      const x = nodes[3 * block.connectivity[item * block.stride + n] + k];
      low = Math.min(low, x); high = Math.max(high, x);
    }
    span[6 * item + k] = low; span[6 * item + 3 + k] = high;
  }
  return span;
});

/** The triangles and lines in which the plane cuts the elements that the page holds. */
function section(axis, at) {
  const positions = [], colours = [], lines = [], points = new Float32Array(3 * 200);
  elements.forEach((block, place) => {
    for (let item = 0; item < block.count; item++) {
      if (spans[place][6 * item + axis] > at || spans[place][6 * item + 3 + axis] < at) continue;
      filled(block, item, points, 0);
      const { simplices, outside } = block.fillings[block.curved[item]];
      const own = paint.of(block, item);
      for (let s = 0; s < simplices.length; s += 4) cutSimplex(points, simplices, outside, s, axis, at, own, positions, colours, lines);
    }
  });
  return { positions, colours, lines };
}

function cutSimplex(points, simplices, outside, s, axis, at, own, positions, colours, lines) {
  const over = [], under = [];
  for (let q = 0; q < 4; q++) (points[3 * simplices[s + q] + axis] >= at ? over : under).push(q);
  if (over.length === 0 || under.length === 0) return;
  const between = (a, b) => {
    const [i, j] = [3 * simplices[s + a], 3 * simplices[s + b]];
    const t = (at - points[i + axis]) / (points[j + axis] - points[i + axis]);
    return [0, 1, 2].map((k) => points[i + k] + t * (points[j + k] - points[i + k]));
  };
  const triangle = (...corners) => corners.forEach((corner) => { positions.push(...corner); colours.push(...own); });
  const line = (opposite, from, to) => { if (outside[s + opposite]) lines.push(...from, ...to); };
  if (over.length === 2) {
    const [a, b] = over, [c, d] = under;
    const [ac, bc, bd, ad] = [between(a, c), between(b, c), between(b, d), between(a, d)];
    triangle(ac, bc, bd); triangle(ac, bd, ad);
    line(d, ac, bc); line(a, bc, bd); line(c, bd, ad); line(b, ad, ac);
  } else {
    const [a] = over.length === 1 ? over : under, [b, c, d] = over.length === 1 ? under : over;
    const [ab, ac, ad] = [between(a, b), between(a, c), between(a, d)];
    triangle(ab, ac, ad);
    line(d, ab, ac); line(b, ac, ad); line(c, ad, ab);
  }
}

let side = 1;
function cut() {
  cutting.clear();
  const axis = by("axis").value;
  const on = axis !== "";
  for (const id of ["at", "exact", "turn"]) by(id).disabled = !on;
  clipping = [];
  if (on) {
    const k = Number(axis), value = Number(by("exact").value) - origin[k];
    const normal = [0, 0, 0];
    normal[k] = -side;
    plane.normal.set(...normal);
    plane.constant = side * value;
    clipping = [plane];
    const { positions, colours, lines } = section(k, value);
    const shape = new THREE.BufferGeometry();
    shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(positions), 3));
    shape.setAttribute("color", new THREE.BufferAttribute(new Float32Array(colours), 3));
    const edges = new THREE.BufferGeometry();
    edges.setAttribute("position", new THREE.BufferAttribute(new Float32Array(lines), 3));
    cutting.add(new THREE.Mesh(shape, sectionMaterial), new THREE.LineSegments(edges, edgeMaterial.clone()));
  }
  for (const material of [surfaceMaterial, edgeMaterial]) { material.clippingPlanes = clipping; material.needsUpdate = true; }
  draw();
}

/** The range in which the plane moves: round what the page holds, along the axis. */
function range() {
  const k = Number(by("axis").value);
  const [low, high] = box(false);
  const grown = 0.3 * Math.hypot(...low.map((x, j) => high[j] - x));
  return [low[k] - grown + origin[k], high[k] + grown + origin[k]];
}
by("axis").onchange = () => { if (by("axis").value !== "") slide(); cut(); };
/** Puts the plane where the slider is, in round steps of which a thousand or more make up the range. */
function slide() {
  const [low, high] = range();
  const step = 10 ** Math.floor(Math.log10((high - low) / 1000));
  const at = low + ((high - low) * by("at").value) / 1000;
  by("exact").value = Number((Math.round(at / step) * step).toPrecision(12));
}
by("at").oninput = () => { slide(); cut(); };
by("exact").onchange = cut;
by("turn").onclick = () => { side = -side; cut(); };

// ---- the elements to look at first

const places = new Map();
pool.forEach((block, b) => block.number.forEach((number, item) => places.set(`${block.cell} ${number}`, [b, item])));

function show(rank) {
  const low = report.lowest[rank];
  const place = low.position.map((x, k) => x - origin[k]);
  marking.clear();
  const found = places.get(`${low.cell} ${low.element}`);
  let size = radius * 0.01;
  if (found) {
    const [block, item] = [pool[found[0]], found[1]];
    const own = new Set(block.connectivity.subarray(item * block.stride, (item + 1) * block.stride));
    const ends = [...own].map((node) => [0, 1, 2].map((k) => nodes[3 * node + k]));
    size = Math.max(...ends.map((x) => Math.hypot(...x.map((value, k) => value - place[k]))));
    const red = new THREE.MeshLambertMaterial({ color: 0xdc143d, side: THREE.DoubleSide });
    marking.add(surface(block, [item], red, true)[0]);
    const lines = [];
    pool.forEach((other) => {
      for (let n = 0; n < other.count; n++) {
        if (other === block && n === item) continue;
        for (let k = 0; k < other.stride; k++) if (own.has(other.connectivity[n * other.stride + k])) { lines.push([other, n]); break; }
      }
    });
    for (const [other, n] of lines.slice(0, 120)) {
      const glass = new THREE.MeshLambertMaterial({ color: 0x4477aa, side: THREE.DoubleSide, transparent: true, opacity: 0.06, depthWrite: false });
      const near = surface(other, [n], glass, true)[0];
      const outline = new THREE.LineSegments(outlined(other, n), new THREE.LineBasicMaterial({ color: 0x223a5e }));
      marking.add(near, outline);
    }
    marking.add(new THREE.LineSegments(outlined(block, item), new THREE.LineBasicMaterial({ color: 0x7a0019 })));
  }
  for (const row of document.querySelectorAll("#lowest tr")) row.classList.toggle("on", row.dataset.rank === String(rank));
  by("picked").textContent = `${low.cell} ${low.element} at (${low.position.join(", ")})` + (found ? "" : ": not held by the page");
  surfaceMaterial.transparent = true; surfaceMaterial.opacity = 0.35; surfaceMaterial.depthWrite = false;
  look(place, 9 * size);
}

/** The edges of an element as curves: where two of the outer triangles of its filling meet at an angle of the cell, by its sides. */
function outlined(block, item) {
  const points = new Float32Array(3 * 200), positions = [];
  filled(block, item, points, 0);
  for (const edge of block.fillings[block.curved[item]].edges) for (let n = 0; n + 1 < edge.length; n++)
    for (const point of [edge[n], edge[n + 1]]) positions.push(points[3 * point], points[3 * point + 1], points[3 * point + 2]);
  const shape = new THREE.BufferGeometry();
  shape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(positions), 3));
  return shape;
}

function opaque() {
  surfaceMaterial.transparent = false; surfaceMaterial.opacity = 1; surfaceMaterial.depthWrite = true;
}

function copy(text) {
  const area = element("textarea", {}, text);
  document.body.append(area);
  area.select();
  document.execCommand("copy");
  area.remove();
}

function list() {
  const all = report.lowest || [];
  const head = element("tr", {}, ...["", "element", "J/J_c", "scaled", "C_WCN", "C_JAC", ""].map((title) => element("th", {}, title)));
  const row = (low, rank) => {
    const button = element("button", { title: "copy number and coordinates" }, "copy");
    button.onclick = (event) => { event.stopPropagation(); copy(`${low.cell} ${low.element} (${low.position.join(", ")})`); };
    const goes = element("button", { "data-show": rank }, String(rank + 1));
    const own = element("tr", { "data-rank": rank, title: `(${low.position.join(", ")})` }, element("td", {}, goes), element("td", {}, `${low.cell} ${low.element}`),
      ...["j_over_jc", "scaled_jacobian", "c_wcn", "c_jac"].map((key) => value(`/lowest/${rank}/${key}`)), element("td", {}, button));
    own.onclick = () => show(rank);
    return own;
  };
  by("lowest").append(all.length ? element("table", {}, head, ...all.map(row)) : element("p", { class: "small" }, "The report lists none."));
}

// ---- controls

function choices() {
  const names = new Set([...faces, ...elements].flatMap((block) => Object.keys(block.values)));
  const all = ["J/J_c", "scaled Jacobian", "C_WCN", "C_JAC", "distance to CAD"].filter((name) => names.has(name)).concat(["patch"]);
  by("colouring").append(...all.map((name) => element("option", { value: name }, name)));
  geometry.patches.forEach((patch, place) => {
    const { r, g, b } = ofPatch(place);
    const tick = element("input", { type: "checkbox" });
    tick.checked = !hidden.has(place);
    tick.onchange = () => { if (tick.checked) hidden.delete(place); else hidden.add(place); refresh(); };
    by("patches").append(element("label", {}, tick, element("span", { class: "swatch", style: `background:rgb(${[r, g, b].map((x) => Math.round(255 * x)).join(",")})` }), patch.name));
  });
}
by("colouring").onchange = () => { paint = painter(by("colouring").value); showScale(by("colouring").value); cut(); refresh(); };
by("edges").onchange = refresh;
by("whole").onclick = () => { opaque(); marking.clear(); by("picked").textContent = ""; whole(); };
by("sampled").textContent = [...geometry.left_out, "Lengths and coordinates are in the mesh's unit; curves are drawn in short straight pieces, coordinates to 7 digits."].join(" ");
window.addEventListener("resize", () => { controls.handleResize(); draw(); });
controls.addEventListener("change", draw);
(function turn() { controls.update(); requestAnimationFrame(turn); })();
choices();
list();
build();
by("colouring").onchange();
controls.handleResize();
whole();
window.sagitta = { camera, controls, show, draw, cut };

// Draws the meshes of a report so that they can be turned: all canvases of a section turn together.
// data-points: base64 of float32 coordinates, three a vertex; data-triangles: base64 of uint32 indices, three
// a triangle, counter-clockwise seen from outside. The first view and the lamp are those of the pictures.
"use strict";
(function () {
  const VIEW = [[-0.5, 0.866, 0.0], [-0.296, -0.171, 0.94], [0.814, 0.47, 0.342]]; // right, up, to the eye
  const LIGHT = [0.343, 0.245, 0.882];
  const COLOUR = [198, 205, 214];
  const STEP = 0.01; // radians a pixel

  function decode(text, Kind) {
    return new Kind(Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0)).buffer);
  }

  function readMesh(canvas) {
    const points = decode(canvas.dataset.points, Float32Array);
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; i++) {
      low[i % 3] = Math.min(low[i % 3], points[i]);
      high[i % 3] = Math.max(high[i % 3], points[i]);
    }
    let radius = 0;
    for (let i = 0; i < points.length; i++) points[i] -= (low[i % 3] + high[i % 3]) / 2;
    for (let i = 0; i < points.length; i += 3) {
      radius = Math.max(radius, Math.hypot(points[i], points[i + 1], points[i + 2]));
    }
    return { canvas, points, radius, triangles: decode(canvas.dataset.triangles, Uint32Array) };
  }

  function project(mesh, rows) {
    const seen = new Float32Array(mesh.points.length);
    for (let i = 0; i < seen.length; i++) {
      const row = rows[i % 3], at = i - (i % 3);
      seen[i] = row[0] * mesh.points[at] + row[1] * mesh.points[at + 1] + row[2] * mesh.points[at + 2];
    }
    return seen;
  }

  function visibleTriangles(mesh, seen) {
    const found = [];
    for (let t = 0; t < mesh.triangles.length; t += 3) {
      const a = 3 * mesh.triangles[t], b = 3 * mesh.triangles[t + 1], c = 3 * mesh.triangles[t + 2];
      const ux = seen[b] - seen[a], uy = seen[b + 1] - seen[a + 1], uz = seen[b + 2] - seen[a + 2];
      const vx = seen[c] - seen[a], vy = seen[c + 1] - seen[a + 1], vz = seen[c + 2] - seen[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx; // normal
      const length = Math.sqrt(x * x + y * y + z * z);
      if (!(z > 1e-6 * length)) continue;
      const lit = (x * LIGHT[0] + y * LIGHT[1] + z * LIGHT[2]) / length;
      found.push({ a, b, c, depth: seen[a + 2] + seen[b + 2] + seen[c + 2], light: 0.35 + 0.65 * Math.max(0, lit) });
    }
    return found.sort((one, other) => one.depth - other.depth);
  }

  function draw(mesh, view) {
    const pen = mesh.canvas.getContext("2d"), { width, height } = mesh.canvas;
    const scale = (view.zoom * 0.48 * Math.min(width, height)) / mesh.radius;
    const seen = project(mesh, view.rows);
    pen.clearRect(0, 0, width, height);
    for (const { a, b, c, light } of visibleTriangles(mesh, seen)) {
      pen.fillStyle = pen.strokeStyle = `rgb(${COLOUR.map((part) => Math.round(part * light)).join(",")})`;
      pen.beginPath();
      for (const corner of [a, b, c]) pen.lineTo(width / 2 + scale * seen[corner], height / 2 - scale * seen[corner + 1]);
      pen.closePath();
      pen.fill();
      pen.stroke(); // closes the hairlines between neighbours
    }
  }

  function turn(rows, x, y) { // what is in front follows the pointer
    const mix = (one, other, p, q) => one.map((part, k) => p * part + q * other[k]);
    let [right, up, eye] = rows;
    [right, eye] = [mix(right, eye, Math.cos(x), Math.sin(x)), mix(right, eye, -Math.sin(x), Math.cos(x))];
    [up, eye] = [mix(up, eye, Math.cos(y), -Math.sin(y)), mix(up, eye, Math.sin(y), Math.cos(y))];
    return [right, up, eye];
  }

  const ARROWS = { ArrowLeft: [-9, 0], ArrowRight: [9, 0], ArrowUp: [0, -9], ArrowDown: [0, 9] };

  for (const section of document.querySelectorAll(".turned")) {
    const meshes = Array.from(section.querySelectorAll("canvas"), readMesh);
    const view = { rows: VIEW, zoom: 1, due: false };
    const drawAll = () => { // once a frame, however many events come
      if (view.due) return;
      view.due = true;
      requestAnimationFrame(() => { view.due = false; meshes.forEach((mesh) => draw(mesh, view)); });
    };
    const move = (x, y) => { view.rows = turn(view.rows, STEP * x, STEP * y); drawAll(); };
    for (const { canvas } of meshes) {
      canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
      canvas.addEventListener("pointermove", (event) => { if (event.buttons) move(event.movementX, event.movementY); });
      canvas.addEventListener("dblclick", () => { view.rows = VIEW; view.zoom = 1; drawAll(); });
      canvas.addEventListener("wheel", (event) => {
        if (!event.ctrlKey) return; // the wheel alone scrolls the page
        event.preventDefault();
        view.zoom = Math.min(8, Math.max(0.3, view.zoom * Math.exp(-0.002 * event.deltaY)));
        drawAll();
      }, { passive: false });
      canvas.addEventListener("keydown", (event) => {
        if (event.key in ARROWS) { event.preventDefault(); move(...ARROWS[event.key]); }
      });
    }
    drawAll();
  }
})();

function bytes(text) { return Uint8Array.from(atob(text), c => c.charCodeAt(0)); }

// The superparticle: points are added up, and their sum is shown as heat, or in the channels' colours.
function turntable(canvas, data) {
  const packed = new DataView(bytes(data.points).buffer), channel = bytes(data.channel), n = data.n;
  const point = new Float32Array(3 * n);
  for (let i = 0; i < 3 * n; ++i) point[i] = packed.getInt16(2 * i, true) / 32767;
  const start = [1, 0, 0, 0, 0.35, 0.94, 0, -0.94, 0.35];  // from above, leaning
  let turn = start.slice();
  const size = canvas.width, context = canvas.getContext("2d"), image = context.createImageData(size, size);
  const colours = Math.max(1, data.tints.length);
  const sum = Array.from({length: colours}, () => new Float32Array(size * size));
  const multiply = (a, b) => a.map((_, k) => {
    const row = 3 * Math.floor(k / 3), column = k % 3;
    return a[row] * b[column] + a[row + 1] * b[3 + column] + a[row + 2] * b[6 + column];
  });
  function draw() {
    for (const s of sum) s.fill(0);
    const scale = 0.47 * size, middle = size / 2;
    for (let i = 0; i < n; ++i) {
      const x = point[3 * i], y = point[3 * i + 1], z = point[3 * i + 2];
      const u = Math.round(middle + scale * (turn[0] * x + turn[1] * y + turn[2] * z));
      const v = Math.round(middle - scale * (turn[3] * x + turn[4] * y + turn[5] * z));
      const s = sum[colours > 1 ? channel[i] : 0];
      for (let dv = -2; dv <= 2; ++dv) {
        for (let du = -2; du <= 2; ++du) {
          if (u + du < 0 || u + du >= size || v + dv < 0 || v + dv >= size) continue;
          s[(v + dv) * size + u + du] += 1 / (1 + du * du + dv * dv);
        }
      }
    }
    const brightest = sum.map(s => s.reduce((most, value) => Math.max(most, value), 1e-9));
    let lit = 0;
    for (let p = 0; p < size * size; ++p) {
      let red = 0, green = 0, blue = 0;
      sum.forEach((s, c) => {
        const value = Math.sqrt(s[p] / brightest[c]);
        if (value > 0) ++lit;
        const tint = colours > 1 ? data.tints[c].map(t => t * value) : [3 * value, 3 * value - 1, 3 * value - 2];
        red += tint[0]; green += tint[1]; blue += tint[2];
      });
      image.data.set([255 * red, 255 * green, 255 * blue, 255], 4 * p);
    }
    context.putImageData(image, 0, 0);
    canvas.dataset.lit = lit;
  }
  let asked = false;
  function rotate(right, down) {
    const a = Math.cos(right), b = Math.sin(right), c = Math.cos(down), d = Math.sin(down);
    turn = multiply([1, 0, 0, 0, c, -d, 0, d, c], multiply([a, 0, b, 0, 1, 0, -b, 0, a], turn));
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; draw(); });
  }
  canvas.addEventListener("pointerdown", e => canvas.setPointerCapture(e.pointerId));
  canvas.addEventListener("pointermove", e => {
    if (e.buttons) rotate(e.movementX / 100, e.movementY / 100);
  });
  canvas.addEventListener("dblclick", () => { turn = start.slice(); rotate(0, 0); });
  canvas.addEventListener("keydown", e => {
    const step = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]}[e.key];
    if (!step) return;
    e.preventDefault();
    rotate(...step);
  });
  document.getElementById("turn-note").textContent = `${n} of ${data.of} localisations.`;
  draw();
}

const turning = JSON.parse(document.getElementById("turn-data").textContent);
if (turning.n > 0) turntable(document.getElementById("turn"), turning);
dataTable(document.getElementById("particle-table"), JSON.parse(document.getElementById("particle-data").textContent), 25);

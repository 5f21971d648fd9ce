// The robot drawn: solids, ground, what the ground and the push do to it; and which solid is under a pointer.
function trace(pen, points, close = true) {
  pen.beginPath();
  points.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  if (close) pen.closePath();
}

// Fill one solid, with an outline in the ground's colour that parts it from those behind.
function paint(pen, solid, look) {
  const base = look.tones[solid.tone];
  pen.lineJoin = "round";
  if (solid.faces) {
    for (const face of solid.faces) {
      trace(pen, face.corners);
      pen.strokeStyle = look.ground;
      pen.lineWidth = 2;
      pen.stroke();
    }
    for (const face of solid.faces) {
      trace(pen, face.corners);
      pen.fillStyle = pen.strokeStyle = shade(base, face.light);
      pen.lineWidth = 0.7;
      pen.fill();
      pen.stroke();
    }
  } else if (solid.radii) {
    const [a, b] = solid.radii;
    pen.beginPath();
    pen.ellipse(solid.x, solid.y, a, b, solid.angle, 0, 2 * Math.PI);
    pen.strokeStyle = look.ground;
    pen.lineWidth = 2;
    pen.stroke();
    const fill = pen.createRadialGradient(solid.x - 0.35 * b, solid.y - 0.45 * b, 0.1 * b, solid.x, solid.y, 1.15 * a);
    fill.addColorStop(0, shade(base, 1));
    fill.addColorStop(1, shade(base, 0.25));
    pen.fillStyle = fill;
    pen.fill();
  } else paintTube(pen, solid, look, base);
}

// A capsule or a cylinder: one thick line, brighter along its lit side.
function paintTube(pen, { type, ends, radius, along }, look, base) {
  const [[x1, y1], [x2, y2]] = ends, length = Math.hypot(x2 - x1, y2 - y1) || 1;
  const [nx, ny] = [-(y2 - y1) / length, (x2 - x1) / length], side = -0.5 * nx - 0.8 * ny < 0 ? -1 : 1;
  const line = (width, colour, shift) => {
    pen.beginPath();
    pen.moveTo(x1 + side * shift * nx, y1 + side * shift * ny);
    pen.lineTo(x2 + side * shift * nx + 0.01, y2 + side * shift * ny);
    pen.lineWidth = width;
    pen.strokeStyle = colour;
    pen.stroke();
  };
  pen.lineCap = type === "capsule" ? "round" : "butt";
  const size = Math.hypot(...along) || 1, tilt = Math.abs(along[2]) / size;
  const cap = (grown, colour) => {
    const [x, y] = along[2] > 0 ? ends[1] : ends[0];
    pen.beginPath();
    pen.ellipse(x, y, radius + grown, (radius + grown) * tilt, Math.atan2(nx, -ny) + Math.PI / 2, 0, 2 * Math.PI);
    pen.fillStyle = colour;
    pen.fill();
  };
  if (type === "cylinder") cap(1, look.ground);
  line(2 * radius + 2, look.ground, 0);
  line(2 * radius, shade(base, 0.35), 0);
  line(1.35 * radius, shade(base, 0.65), 0.26 * radius);
  line(0.6 * radius, shade(base, 0.92), 0.42 * radius);
  if (type === "cylinder") cap(0, shade(base, 0.55));
  pen.lineCap = "butt";
}

// A colour [r, g, b] in light from 0 to 1, as text.
const shades = new Map();
function shade(base, light) {
  const step = Math.round(light * 20), key = step * 16777216 + base[0] * 65536 + base[1] * 256 + base[2];
  if (!shades.has(key)) {
    const part = 0.72 + 0.33 * (step / 20);
    shades.set(key, `rgb(${base.map((value) => Math.round(Math.min(255, value * part))).join(" ")})`);
  }
  return shades.get(key);
}

// The ground: lines half a metre apart that stay where they are in the world, and the soles' shadows.
function paintGround(pen, pose, view, look) {
  const { x, y } = view.course, reach = 1.1;
  pen.lineWidth = 1;
  pen.strokeStyle = look.grid;
  for (let k = -3; k <= 3; k++) {
    const [u, v] = [0.5 * (Math.round(2 * x) + k), 0.5 * (Math.round(2 * y) + k)];
    const across = [[u - x, [u, y - reach, 0], [u, y + reach, 0]], [v - y, [x - reach, v, 0], [x + reach, v, 0]]];
    for (const [away, from, to] of across) {
      if (Math.abs(away) >= reach) continue;
      trace(pen, [view.at(from), view.at(to)], false);
      pen.stroke();
    }
  }
  if (!robot.sole) return;
  const [centre, half] = robot.sole;
  for (const body of robot.feet) {
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
      const [u, v] = placed(pose, body, [centre[0] + a * half[0] * 1.05, centre[1] + b * half[1] * 1.1, centre[2]]);
      return view.at([u, v, 0]);
    });
    trace(pen, corners);
    pen.fillStyle = look.shadow;
    pen.fill();
  }
}

function paintArrow(pen, [x1, y1], [x2, y2], colour, width) {
  const angle = Math.atan2(y2 - y1, x2 - x1), head = 3.2 * width;
  if (Math.hypot(x2 - x1, y2 - y1) < head) return;
  pen.strokeStyle = pen.fillStyle = colour;
  pen.lineWidth = width;
  pen.lineCap = "round";
  trace(pen, [[x1, y1], [x2 - 0.8 * head * Math.cos(angle), y2 - 0.8 * head * Math.sin(angle)]], false);
  pen.stroke();
  const corner = (turn) => [x2 + 1.25 * head * Math.cos(angle + turn), y2 + 1.25 * head * Math.sin(angle + turn)];
  trace(pen, [[x2, y2], corner(2.65), corner(-2.65)]);
  pen.fill();
  pen.lineCap = "butt";
}

// What the ground does to each foot, in the foot's axes, as arrows of a third of a metre at the robot's weight.
function paintContacts(pen, scene, row, pose, view, look) {
  if (!robot.sole) return;
  robot.feet.forEach((body, k) => {
    const force = turned(pose.rotations[body], vectorAt(scene, "wrenches", 3 * k, row)), size = Math.hypot(...force);
    if (size < 30) return;
    const foot = placed(pose, body, robot.sole[0]);
    const tip = plus(foot, force, 0.00035);
    paintArrow(pen, view.at(foot), view.at(tip), look.contact, 3);
  });
}

// The push: an arrow that ends where it meets the robot, or one round the joint that it turns; it fades afterwards.
function paintPush(pen, scene, row, pose, view, look) {
  const fade = 0.35 * scene.rate;
  if (row < scene.start || row > scene.end + fade) return;
  const during = row < scene.end, at = during ? row : largestPush(scene);
  pen.globalAlpha = during ? 1 : 0.45 * (1 - (row - scene.end) / fade);
  if (scene.point) {
    const [body, place] = scene.point, force = vectorAt(scene, "force", 0, at);
    const most = Math.hypot(...vectorAt(scene, "force", 0, largestPush(scene)));
    const point = placed(pose, body, place), length = 0.42 / (most || 1);
    paintArrow(pen, view.at(plus(point, force, -length)), view.at(point), look.push, 6);
  } else paintTurn(pen, scene, pose, view, look);
  pen.globalAlpha = 1;
}

function paintTurn(pen, scene, pose, view, look) {
  const joint = robot.joints.find(([id]) => id === scene.turned);
  if (!joint) return;
  const [, body, axis] = joint, k = scene.joints.findIndex(([name]) => name === scene.turned);
  const push = column(scene, "push", k), sign = push[Math.round((scene.start + scene.end) / 2)] < 0 ? -1 : 1;
  const [u, v] = acrossOf(axis), points = [];
  for (let part = 0; part <= 30; part++) {
    const angle = sign * (part / 30) * 1.5 * Math.PI;
    const local = [0, 1, 2].map((i) => 0.2 * (u[i] * Math.cos(angle) + v[i] * Math.sin(angle)));
    points.push(view.at(placed(pose, body, local)));
  }
  pen.strokeStyle = look.push;
  pen.lineWidth = 6;
  trace(pen, points.slice(0, -2), false);
  pen.stroke();
  const [[x1, y1], [x2, y2]] = points.slice(-2), size = Math.hypot(x2 - x1, y2 - y1) || 1;
  paintArrow(pen, [x2 - (24 * (x2 - x1)) / size, y2 - (24 * (y2 - y1)) / size], [x2, y2], look.push, 6);
}

// Two directions across an axis, in a right-handed turn about it.
function acrossOf([x, y, z]) {
  const other = Math.abs(z) < 0.9 ? [0, 0, 1] : [1, 0, 0];
  const u = [y * other[2] - z * other[1], z * other[0] - x * other[2], x * other[1] - y * other[0]];
  const size = Math.hypot(...u), unit = u.map((part) => part / size);
  return [unit, [y * unit[2] - z * unit[1], z * unit[0] - x * unit[2], x * unit[1] - y * unit[0]]];
}

// The row at which the force that pushes is largest.
function largestPush(scene) {
  if (scene.largest === undefined) {
    let most = -1;
    for (let row = scene.start; row < scene.end; row += scene.rate / told.settings.poseHz) {
      const size = Math.hypot(...vectorAt(scene, "force", 0, row));
      if (size > most) [most, scene.largest] = [size, row];
    }
  }
  return scene.largest;
}

// The push as text: its force, or the torque that it ends up with on the joint; nothing while none acts.
function pushText(scene, row) {
  if (row < scene.start || row >= scene.end) return "";
  if (scene.point) return `${Math.hypot(...vectorAt(scene, "force", 0, row)).toFixed(0)} N`;
  const push = column(scene, "push", scene.joints.findIndex(([name]) => name === scene.turned));
  return `${Math.abs(push[scene.end - 1]).toFixed(0)} N m`;
}

// Draw the robot at a sample of a scene; a limb is marked, and a leg that is hit leaves a trace.
function drawRobot(pen, scene, row, width, height, turn, limb, look) {
  const pose = posed(positionAt(scene, row)), view = viewOf(scene, row, width, height, turn);
  pen.clearRect(0, 0, width, height);
  paintGround(pen, pose, view, look);
  paintGhosts(pen, scene, row, view, look);
  const solids = solidsOf(pose, view);
  for (const solid of solids) paint(pen, solid, limbOf(solid.body) === limb ? look.marked : look);
  paintContacts(pen, scene, row, pose, view, look);
  paintPush(pen, scene, row, pose, view, look);
  return solids;
}

// The limb that is hit, as it stood up to 0.3 s ago.
function paintGhosts(pen, scene, row, view, look) {
  const hit = scene.point ? limbOf(scene.point[0]) : "";
  if (!hit || row < scene.start || row > scene.end + 0.6 * scene.rate) return;
  pen.lineCap = "round";
  for (const [k, before] of [0.3, 0.2, 0.1].entries()) {
    const then = posed(positionAt(scene, row - before * scene.rate));
    pen.globalAlpha = 0.16 + 0.07 * k;
    pen.strokeStyle = look.ghost;
    for (const [body, , size, place] of robot.shapes)
      if (place.length === 6 && limbOf(body) === hit) {
        const ends = [place.slice(0, 3), place.slice(3)].map((end) => view.at(placed(then, body, end)));
        pen.lineWidth = 2 * size[0] * view.scale;
        trace(pen, ends, false);
        pen.stroke();
      }
  }
  pen.globalAlpha = 1;
  pen.lineCap = "butt";
}

const limbs = robot.bodies.map(([parent], body) => jointOfBody.get(body)?.limb ?? body);
function limbOf(body) {
  while (typeof limbs[body] === "number" && robot.bodies[body][0] >= 0) body = robot.bodies[body][0];
  return limbs[body];
}

// The nearest solid under a place of the picture, as the joint that moves it, or the next one towards the base.
function jointUnder(solids, x, y, known) {
  for (const solid of [...solids].reverse()) {
    if (!covers(solid, x, y)) continue;
    for (let body = solid.body; body >= 0; body = robot.bodies[body][0]) {
      const joint = jointOfBody.get(body);
      if (joint && known.includes(joint.id)) return joint.id;
    }
    return null;
  }
  return null;
}

function covers(solid, x, y) {
  if (solid.faces) return solid.faces.some(({ corners }) => isInside(corners, x, y));
  if (solid.radii) return Math.hypot(x - solid.x, y - solid.y) < solid.radii[0];
  const [[x1, y1], [x2, y2]] = solid.ends, length = (x2 - x1) ** 2 + (y2 - y1) ** 2 || 1;
  const share = Math.max(0, Math.min(1, ((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length));
  return Math.hypot(x - x1 - share * (x2 - x1), y - y1 - share * (y2 - y1)) < solid.radius;
}

function isInside(corners, x, y) {
  let inside = false;
  corners.forEach(([x1, y1], k) => {
    const [x2, y2] = corners[(k + 1) % corners.length];
    if (y1 > y !== y2 > y && x < ((x2 - x1) * (y - y1)) / (y2 - y1) + x1) inside = !inside;
  });
  return inside;
}

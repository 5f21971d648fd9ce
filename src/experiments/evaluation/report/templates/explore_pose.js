// The robot at a time: forward kinematics of its pose, and its solids on an orthographic picture, farther ones first.
const TURN = Math.PI / 180;
const robot = told.robot;
const jointOfBody = new Map(robot.joints.map(([id, body, axis, limb], k) => [body, { id, axis, limb, k }]));

function product(a, b) {
  const found = new Float64Array(9);
  for (let i = 0; i < 9; i += 3)
    for (let j = 0; j < 3; j++) found[i + j] = a[i] * b[j] + a[i + 1] * b[3 + j] + a[i + 2] * b[6 + j];
  return found;
}

function turned(m, [x, y, z]) {
  return [m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z];
}

function plus(a, b, share = 1) {
  return [a[0] + share * b[0], a[1] + share * b[1], a[2] + share * b[2]];
}

function matrixOf(w, x, y, z) {
  const size = Math.hypot(w, x, y, z);
  [w, x, y, z] = [w / size, x / size, y / size, z / size];
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
  ];
}

const FIXED = robot.bodies.map(([, , quat]) => matrixOf(...quat));

// Rotation and origin of every body at a position q (nq): base position, base quaternion w x y z, joints.
function posed(q) {
  const rotations = [matrixOf(q[3], q[4], q[5], q[6])], origins = [[q[0], q[1], q[2]]];
  for (let b = 1; b < robot.bodies.length; b++) {
    const [parent, offset] = robot.bodies[b], joint = jointOfBody.get(b);
    origins[b] = plus(origins[parent], turned(rotations[parent], offset));
    rotations[b] = product(rotations[parent], FIXED[b]);
    if (joint) {
      const half = q[7 + joint.k] / 2, s = Math.sin(half);
      rotations[b] = product(rotations[b], matrixOf(Math.cos(half), ...joint.axis.map((part) => s * part)));
    }
  }
  return { rotations, origins };
}

function placed(pose, body, point) {
  return plus(pose.origins[body], turned(pose.rotations[body], point));
}

// Position at a time, between two stored poses; the base's quaternion is renormalised by `matrixOf`.
function positionAt(scene, row) {
  const place = (row / scene.rate) * told.settings.poseHz, part = scene.parts.poses;
  const first = Math.max(0, Math.min(Math.floor(place), part.count - 2)), share = Math.min(place - first, 1);
  const q = new Float64Array(part.width);
  for (let k = 0; k < part.width; k++) {
    const values = column(scene, "poses", k);
    q[k] = values[first] + share * (values[first + 1] - values[first]);
  }
  return q;
}

function vectorAt(scene, name, from, row) {
  const place = (row / scene.rate) * told.settings.poseHz, last = scene.parts[name].count - 1;
  const first = Math.max(0, Math.min(Math.floor(place), last - 1)), share = Math.min(place - first, 1);
  return [0, 1, 2].map((k) => {
    const values = column(scene, name, from + k);
    return values[first] + share * (values[first + 1] - values[first]);
  });
}

// Axes of a picture in the world's: right, up and towards the eye.
function projection(azimuth, elevation) {
  const [a, e] = [azimuth * TURN, elevation * TURN];
  return [
    -Math.sin(a), Math.cos(a), 0,
    -Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e),
    Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e),
  ];
}

// Where the robot stands and faces, over a step and more, so that the picture does not sway with it.
function courseOf(scene, row) {
  const part = scene.parts.poses, rate = told.settings.poseHz, middle = Math.round((row / scene.rate) * rate);
  const half = Math.round(0.7 * rate);
  const first = Math.max(0, middle - half), last = Math.min(part.count - 1, middle + half);
  let x = 0, y = 0, sin = 0, cos = 0;
  for (let k = first; k <= last; k += 5) {
    const [w, i, j, l] = [3, 4, 5, 6].map((n) => column(scene, "poses", n)[k]);
    const yaw = Math.atan2(2 * (w * l + i * j), 1 - 2 * (j * j + l * l));
    x += column(scene, "poses", 0)[k];
    y += column(scene, "poses", 1)[k];
    sin += Math.sin(yaw);
    cos += Math.cos(yaw);
  }
  const count = Math.floor((last - first) / 5) + 1;
  return { x: x / count, y: y / count, yaw: Math.atan2(sin, cos) / TURN };
}

// A view of the robot on a canvas of so many pixels, with room for a text at the top: where a point of the world is,
// and how large a metre.
function viewOf(scene, row, width, height, turn) {
  const course = courseOf(scene, row), axes = projection(course.yaw + turn.azimuth, turn.elevation);
  const top = 34, scale = Math.min((height - top) / 1.93, width / 1.35);
  const centre = turned(axes, [course.x, course.y, 0.9]);
  const at = (point) => {
    const [x, y, depth] = turned(axes, point);
    return [width / 2 + scale * (x - centre[0]), top + (height - top) * 0.51 - scale * (y - centre[1]), depth];
  };
  return { axes, scale, at, course };
}

// The robot's solids as shapes of the picture, the farther ones first.
function solidsOf(pose, view) {
  const found = robot.shapes.map(([body, type, size, place, tone]) => {
    const rotation = pose.rotations[body];
    if (place.length === 6) {
      const ends = [place.slice(0, 3), place.slice(3)].map((end) => view.at(placed(pose, body, end)));
      const depth = (ends[0][2] + ends[1][2]) / 2, along = turned(rotation, minus(place.slice(3), place.slice(0, 3)));
      return { body, tone, type, depth, ends, radius: size[0] * view.scale, along: turned(view.axes, along) };
    }
    const [x, y, depth] = view.at(placed(pose, body, place));
    if (type === "box") return { body, tone, type, depth, faces: facesOf(pose, view, body, place, size), rotation };
    const half = size.length === 3 ? size : [size[0], size[0], size[0]];
    return { body, tone, type, depth, x, y, ...ellipseOf(product(view.axes, rotation), half, view.scale) };
  });
  return found.sort((a, b) => a.depth - b.depth);
}

function minus(a, b) {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

// The outline of an ellipsoid: the picture of its half axes is a matrix, whose singular values are the outline's.
function ellipseOf(seen, half, scale) {
  let xx = 0, xy = 0, yy = 0;
  for (let k = 0; k < 3; k++) {
    const [x, y] = [seen[k] * half[k], -seen[3 + k] * half[k]];
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const middle = (xx + yy) / 2, apart = Math.hypot((xx - yy) / 2, xy);
  const radii = [Math.sqrt(middle + apart) * scale, Math.sqrt(Math.max(middle - apart, 0)) * scale];
  return { radii, angle: Math.atan2(2 * xy, xx - yy) / 2 };
}

// The faces of a box that are seen, and how bright each is.
function facesOf(pose, view, body, centre, half) {
  const faces = [];
  for (let k = 0; k < 3; k++)
    for (const sign of [-1, 1]) {
      const normal = [0, 0, 0];
      normal[k] = sign;
      const seen = turned(view.axes, turned(pose.rotations[body], normal));
      if (seen[2] <= 0) continue;
      const [i, j] = [(k + 1) % 3, (k + 2) % 3];
      const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
        const corner = [...centre];
        corner[k] += sign * half[k];
        corner[i] += a * half[i];
        corner[j] += b * half[j];
        return view.at(placed(pose, body, corner));
      });
      faces.push({ corners, light: brightness(seen) });
    }
  return faces;
}

// Light comes from the upper left, in front.
function brightness([x, y, depth]) {
  return Math.max(0, -0.45 * x + 0.7 * y + 0.55 * depth);
}

// SPDX-License-Identifier: BSD-3-Clause
// The three-dimensional view of a run in the report. It reads the data that run_view.cpp wrote: lengths in mm, poses as [x, y, z, qw, qx, qy, qz], arrays as base64.
(function () {
  "use strict";
  const run = JSON.parse(document.getElementById("run-data").textContent);
  const box = document.getElementById("run-view");
  const canvas = box.querySelector("canvas");
  const slider = box.querySelector("input");
  const button = box.querySelector("button");
  const label = box.querySelector("output");
  const views = box.querySelector("select");

  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ canvas: canvas, antialias: true });
  } catch (error) {
    box.querySelector(".screen").textContent =
      "This browser shows no three-dimensional view here (it has no WebGL); the pictures below show the run.";
    return;
  }
  renderer.setClearColor(0xffffff);
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));

  function decode(text, Type) {
    const raw = atob(text);
    const bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
    return new Type(bytes.buffer);
  }

  function place(object, pose) {
    object.position.set(pose[0], pose[1], pose[2]);
    object.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
  }

  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(30, 1, 0.1, 1000);
  camera.up.set(0, 0, 1);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x9a9a9a, 0.75));
  const lamp = new THREE.DirectionalLight(0xffffff, 0.55);
  scene.add(lamp);

  // `run` is the box around everything during the run, `assembly` the box around its end.
  function boxOf(data) {
    return new THREE.Box3(new THREE.Vector3().fromArray(data.min), new THREE.Vector3().fromArray(data.max));
  }
  const wholeRun = boxOf(run.run), assembly = boxOf(run.assembly);
  const ball = wholeRun.getBoundingSphere(new THREE.Sphere());

  // A weak lamp above casts a soft shadow on the floor.
  const sun = new THREE.DirectionalLight(0xffffff, 0.2);
  sun.position.set(-0.35, -0.3, 1).normalize().multiplyScalar(3 * ball.radius).add(ball.center);
  sun.target.position.copy(ball.center);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.radius = 4;
  const reach = 1.3 * ball.radius;
  Object.assign(sun.shadow.camera, { left: -reach, right: reach, bottom: -reach, top: reach,
    near: 0.1 * ball.radius, far: 8 * ball.radius });
  scene.add(sun, sun.target);
  const floor = new THREE.Mesh(new THREE.PlaneBufferGeometry(12 * ball.radius, 12 * ball.radius),
    new THREE.ShadowMaterial({ opacity: 0.28 }));
  floor.position.set(ball.center.x, ball.center.y, run.run.min[2] - 0.002 * ball.radius);
  floor.receiveShadow = true;
  scene.add(floor);

  const kInHand = 0x2f6fde;
  const lines = new THREE.LineBasicMaterial({ color: 0x222222 });

  function shapeOf(part) {
    const shape = new THREE.BufferGeometry();
    shape.setAttribute("position", new THREE.BufferAttribute(decode(part.places, Float32Array), 3));
    shape.setAttribute("normal", new THREE.BufferAttribute(decode(part.normals, Int8Array), 3, true));
    if (part.colors) shape.setAttribute("color", new THREE.BufferAttribute(decode(part.colors, Uint8Array), 3, true));
    shape.setIndex(new THREE.BufferAttribute(decode(part.triangles, Uint32Array), 1));
    return shape;
  }

  const parts = run.parts.map(function (part) {
    const group = new THREE.Group();
    const shape = shapeOf(part);
    const color = new THREE.Color(part.color);
    const paint = new THREE.MeshPhongMaterial({
      color: color, specular: 0x222222, shininess: 25, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1
    });
    const solid = new THREE.Mesh(shape, paint);
    solid.castShadow = true;
    group.add(solid);
    const edges = new THREE.BufferGeometry();
    edges.setAttribute("position", new THREE.BufferAttribute(decode(part.edges, Float32Array), 3));
    group.add(new THREE.LineSegments(edges, lines));
    group.visible = part.fixed;
    if (part.fixed) place(group, part.pose);
    scene.add(group);
    return { group: group, shape: shape, paint: paint, color: color, fixed: part.fixed,
      hasFaceColors: Boolean(part.colors) };
  });
  // Faces have their own colours, unless the part is in hand.
  function paintPart(part, isInHand) {
    const showsFaces = part.hasFaceColors && !isInHand;
    if (isInHand) part.paint.color.set(kInHand);
    else if (showsFaces) part.paint.color.set(0xffffff);
    else part.paint.color.copy(part.color);
    // The value is THREE.VertexColors before release 114 of three.js, and `true` from then on.
    const mode = Number(THREE.REVISION) < 114 ? (showsFaces ? THREE.VertexColors : THREE.NoColors) : showsFaces;
    if (part.paint.vertexColors === mode) return;
    part.paint.vertexColors = mode;
    part.paint.needsUpdate = true;
  }

  const hint = new THREE.Mesh(undefined, new THREE.MeshBasicMaterial(
    { color: kInHand, transparent: true, opacity: 0.16, depthWrite: false }));
  hint.visible = false;
  scene.add(hint);

  let box3 = assembly;  // the box that the camera shows
  let isTurned = false;   // whether the reader has turned the view; the camera then stays
  const kViews = {
    corner: [0.75, -1.25, 0.85], front: [0, -1, 0], right: [1, 0, 0], back: [0, 1, 0], left: [-1, 0, 0],
    top: [0, -0.001, 1]
  };
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.addEventListener("change", draw);
  controls.addEventListener("start", function () { isTurned = true; });

  // The range of the box's corners in the picture, from -1 to 1 in both directions.
  function cornersSeen() {
    camera.updateMatrixWorld();
    const seen = new THREE.Box2();
    for (let i = 0; i < 8; ++i) {
      const corner = new THREE.Vector3(i & 1 ? box3.max.x : box3.min.x, i & 2 ? box3.max.y : box3.min.y,
        i & 4 ? box3.max.z : box3.min.z).project(camera);
      seen.expandByPoint(new THREE.Vector2(corner.x, corner.y));
    }
    return seen;
  }

  // Centres the box and moves the camera as near as the box fits. Near parts look larger, so centre and distance are found alternately.
  function look(name) {
    const kFilled = 0.86;
    const target = box3.getCenter(new THREE.Vector3());
    const back = new THREE.Vector3().fromArray(kViews[name]).normalize();
    const tangent = Math.tan(0.5 * camera.fov * Math.PI / 180);
    let away = 1.5 * box3.getBoundingSphere(new THREE.Sphere()).radius / Math.min(tangent, tangent * camera.aspect);
    for (let turn = 0; turn < 6; ++turn) {
      camera.position.copy(back).multiplyScalar(away).add(target);
      camera.lookAt(target);
      camera.near = 0.02 * away;
      camera.far = 20 * away;
      camera.updateProjectionMatrix();
      const seen = cornersSeen(), middle = seen.getCenter(new THREE.Vector2()), size = seen.getSize(new THREE.Vector2());
      const across = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
      const up = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
      target.addScaledVector(across, middle.x * away * tangent * camera.aspect).addScaledVector(up, middle.y * away * tangent);
      away *= 0.5 * Math.max(size.x, size.y) / kFilled;
    }
    camera.position.copy(back).multiplyScalar(away).add(target);
    controls.target.copy(target);
    controls.update();
    draw();
  }

  // Moves the camera as near as possible: to the assembly once the run has ended, otherwise to everything that the run reaches.
  function frameFor(index) {
    const wanted = index + 1 >= run.frames.length ? assembly : wholeRun;
    if (wanted === box3 || isTurned) return;
    box3 = wanted;
    look(views.value);
  }

  // Places the bodies as at the beginning of the step, and then the part in hand at its current pose.
  function show(index) {
    frameFor(index);
    const frame = run.frames[index];
    const isLast = index + 1 === run.frames.length;
    const step = frame ? run.steps[frame[1]] : null;
    const bodies = isLast || !step ? run.finished : step.bodies;
    for (const part of parts) {
      part.group.visible = part.fixed;
      paintPart(part, false);
    }
    for (const body of bodies) {
      place(parts[body[0]].group, body.slice(1));
      parts[body[0]].group.visible = true;
    }
    hint.visible = Boolean(step) && !isLast;
    if (!hint.visible) {
      label.textContent = "the assembly at the end of the run";
      return;
    }
    const held = parts[step.part];
    place(held.group, frame.slice(2, 9));
    held.group.visible = true;
    paintPart(held, true);
    hint.geometry = held.shape;
    place(hint, step.target);
    label.textContent = frame[0].toFixed(2) + " s · " + step.name + " · " + frame[9].toFixed(1) + " N on the hand · " +
      (frame[10] > 0 ? frame[10].toFixed(1) + " µm deep" : frame[11] > 0 ? "in contact" : "no contact");
  }

  let isDue = false;
  function draw() {
    if (isDue) return;
    isDue = true;
    requestAnimationFrame(function () {
      isDue = false;
      lamp.position.copy(camera.position);
      renderer.render(scene, camera);
    });
  }

  function resize() {
    const width = box.clientWidth, height = Math.round(Math.min(0.62 * width, 0.8 * window.innerHeight));
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  }

  let from = null;  // while playing: wall-clock time and time of the run when play began; null: paused
  function play(now) {
    if (!from) return;
    const time = from.run + 1e-3 * (now - from.wall);
    let index = Number(slider.value);
    while (index + 1 < run.frames.length && run.frames[index + 1][0] <= time) ++index;
    slider.value = index;
    show(index);
    draw();
    if (index + 1 < run.frames.length) requestAnimationFrame(play);
    else stop();
  }
  function stop() {
    from = null;
    button.textContent = "Play";
  }
  button.addEventListener("click", function () {
    if (from) return stop();
    if (Number(slider.value) + 1 >= run.frames.length) slider.value = 0;
    from = { wall: performance.now(), run: run.frames[Number(slider.value)][0] };
    button.textContent = "Stop";
    requestAnimationFrame(play);
  });
  slider.addEventListener("input", function () {
    stop();
    show(Number(slider.value));
    draw();
  });
  views.addEventListener("change", function () {
    isTurned = false;
    look(views.value);
  });
  window.addEventListener("resize", resize);

  slider.max = Math.max(0, run.frames.length - 1);
  slider.value = slider.max;
  button.disabled = run.frames.length < 2;
  resize();
  show(Number(slider.value));
  look("corner");
})();

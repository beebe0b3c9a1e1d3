// SPDX-License-Identifier: BSD-3-Clause
// The page of vps watch --web. Lengths are metres from the centre of the scene, in the group `root`, which is drawn in
// millimetres on a screen and at the size of a table in a headset. snapshot_coder.h and browser_message.h describe the
// messages.
(function () {
  "use strict";
  const $ = function (id) { return document.getElementById(id); };
  const canvas = $("view"), stage = $("stage");
  const kInHand = 0x2f6fde, kForceColor = 0x8a2be2, kScreenScale = 1000;
  // State of the page, for tests and for inspection.
  const seen = window.vps = { snapshots: 0, drawn: 0, ages_ms: [], shown: [], heardAfter_ms: [], blows: 0, pointers: {}, bodies: {}, hand: null, you: 0 };

  // ---- drawing

  // Without a graphics card, smooth edges take two thirds of the time of a picture, and triangles and lighting per pixel
  // most of the rest. Such a browser draws neither, and it draws coarse parts while anything moves.
  function isDrawnByProcessor() {
    const probe = document.createElement("canvas").getContext("webgl");
    if (!probe) return false;
    const info = probe.getExtension("WEBGL_debug_renderer_info");
    const name = String(probe.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : probe.RENDERER));
    const end = probe.getExtension("WEBGL_lose_context");
    if (end) end.loseContext();
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
  }
  const isSlow = seen.isSlow = isDrawnByProcessor();

  let renderer;
  try {
    // Without alpha the browser need not blend the canvas with the page.
    const context = canvas.getContext("webgl", { alpha: false, antialias: !isSlow, xrCompatible: true });
    renderer = new THREE.WebGLRenderer({ canvas: canvas, context: context, antialias: !isSlow });
  } catch (error) {
    $("doing").textContent = "This browser cannot show a three-dimensional view, because it has no WebGL.";
    return;
  }
  renderer.setClearColor(0xffffff);
  const fullRatio = Math.min(window.devicePixelRatio || 1, isSlow ? 1 : 2);
  renderer.setPixelRatio(fullRatio);
  renderer.localClippingEnabled = true;

  const world = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(30, 1, 1, 1e5);
  camera.up.set(0, 0, 1);
  world.add(camera);
  world.add(new THREE.HemisphereLight(0xffffff, 0x9a9a9a, 0.75));
  const lamp = new THREE.DirectionalLight(0xffffff, 0.55);
  world.add(lamp);
  const root = new THREE.Group();
  root.scale.setScalar(kScreenScale);
  world.add(root);
  const controls = new THREE.OrbitControls(camera, canvas);
  let isDue = true;
  let moved_ms = 0;  // time of the last change of the picture
  function redraw() {
    isDue = true;
    moved_ms = performance.now();
  }
  controls.addEventListener("change", redraw);

  const kLooks = {
    corner: [0.75, -1.25, 0.85], front: [0, -1, 0], right: [1, 0, 0], back: [0, 1, 0], left: [-1, 0, 0],
    top: [0, -0.001, 1]
  };
  let radius_m = 0.1;
  function look(name) {
    const half = 0.5 * camera.fov * Math.PI / 180;
    const away = 1.1 * kScreenScale * radius_m / Math.sin(Math.min(half, Math.atan(Math.tan(half) * camera.aspect)));
    camera.position.fromArray(kLooks[name]).normalize().multiplyScalar(away);
    camera.near = 0.01 * away;
    camera.far = 20 * away;
    camera.updateProjectionMatrix();
    controls.target.set(0, 0, 0);
    controls.update();
    redraw();
  }
  function resize() {
    const width = Math.max(1, stage.clientWidth), height = Math.max(1, stage.clientHeight);
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    redraw();
  }
  new ResizeObserver(resize).observe(stage);  // the size also changes when a button appears and the tools need another line

  // ---- the scene

  let scene = null;      // description of the scene in the hello message
  let parts = [];        // by index of the part: group, paint, surface
  let inHand = -1, target = null;
  const lines = new THREE.LineBasicMaterial({ color: 0x222222 });
  const hint = new THREE.Group();
  const hintPaint = new THREE.MeshBasicMaterial({ color: kInHand, transparent: true, opacity: 0.16, depthWrite: false });
  const cutPlane = new THREE.Plane();
  const center = new THREE.Vector3();

  function place(object, pose) {
    object.position.set(pose[0], pose[1], pose[2]);
    object.quaternion.set(pose[3], pose[4], pose[5], pose[6]);
  }
  function centered(pose) {
    return [pose[0] - center.x, pose[1] - center.y, pose[2] - center.z].concat(pose.slice(3));
  }

  function begin(hello) {
    for (const part of parts) root.remove(part.group);
    parts = [];
    inHand = -1;
    target = null;
    seen.bodies = {};
    scene = hello;
    center.fromArray(hello.center);
    radius_m = hello.radius;
    $("name").textContent = hello.name;
    $("verdict").textContent = "";
    parts = hello.parts.map(function (part, index) {
      const group = new THREE.Group();
      group.visible = part.fixed;
      if (part.fixed) place(group, centered(part.pose));
      root.add(group);
      const offset = { side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
      const entry = {
        group: group, name: part.name, color: new THREE.Color(part.color), surface: null, coarse: null, fine: null,
        paint: isSlow ? new THREE.MeshLambertMaterial(offset)
          : new THREE.MeshPhongMaterial(Object.assign({ specular: 0x222222, shininess: 25 }, offset)),
        inside: new THREE.MeshBasicMaterial({ side: THREE.BackSide })
      };
      entry.paint.color.copy(entry.color);
      entry.inside.color.copy(entry.color).multiplyScalar(0.55);
      fetchPart(entry, hello.run, index, part.triangles);
      return entry;
    });
    root.add(hint);
    hint.visible = false;
    applyCut();
    look($("looks").value);
  }

  // Colours of faces (linear, as in glTF) replace the part's colour, unless the part is in hand.
  function useFaceColors(entry, geometry) {
    const values = geometry.attributes.color.array;
    for (let i = 0; i < values.length; ++i)
      values[i] = values[i] <= 0.0031308 ? 12.92 * values[i] : 1.055 * Math.pow(values[i], 1 / 2.4) - 0.055;
    entry.hasFaceColors = true;
    paintPart(entry, parts[inHand] === entry);
  }
  function paintPart(entry, isInHand) {
    entry.paint.color.copy(entry.color);
    if (isInHand) entry.paint.color.set(kInHand);
    else if (entry.hasFaceColors) entry.paint.color.set(0xffffff);
    entry.paint.vertexColors = faceColorsMode(Boolean(entry.hasFaceColors) && !isInHand);
    entry.paint.needsUpdate = true;
  }
  // three.js before release 114 needs THREE.VertexColors; later releases need true.
  function faceColorsMode(isOn) {
    return Number(THREE.REVISION) < 114 ? (isOn ? THREE.VertexColors : THREE.NoColors) : isOn;
  }

  function fetchPart(entry, run, index, triangles) {
    const loader = new THREE.GLTFLoader();
    const path = "/part/" + run + "/" + index + "/";
    function add(file, level) {
      if (!scene || parts[index] !== entry) return;
      const shape = entry[level] = { all: new THREE.Group(), surface: null, back: null };
      file.scene.updateMatrixWorld(true);
      file.scene.traverse(function (object) {
        if (!object.isMesh && !object.isLineSegments) return;
        const geometry = object.geometry.clone().applyMatrix(object.matrixWorld);
        if (object.isLineSegments) {
          shape.all.add(new THREE.LineSegments(geometry, lines));
          return;
        }
        if (geometry.attributes.color) useFaceColors(entry, geometry);
        shape.surface = new THREE.Mesh(geometry, entry.paint);
        shape.back = new THREE.Mesh(geometry, entry.inside);
        shape.all.add(shape.surface, shape.back);
      });
      entry.group.add(shape.all);
      useLevel(entry);
      if (target && target.part === index) showTarget();
      applyCut();
      redraw();
    }
    function fine() { loader.load(path + "fine.glb", function (file) { add(file, "fine"); }); }
    const kWorthCoarse = 20000;
    if (triangles < kWorthCoarse) return fine();
    loader.load(path + "coarse.glb", function (file) { add(file, "coarse"); fine(); });
  }

  // Shows the fine shapes, or the coarse ones in a slow browser while anything moves.
  let isCoarse = isSlow;
  function useLevel(part) {
    const used = (isCoarse && part.coarse) || part.fine || part.coarse;
    for (const shape of [part.coarse, part.fine]) if (shape) shape.all.visible = shape === used;
    part.surface = used ? used.surface : null;
  }
  // A slow browser draws motion with as many pixels as it can draw 30 times a second, and the last picture of a motion in full.
  const kStill_ms = 400, kWanted_ms = 33, kShares = [1, 0.71, 0.5, 0.35];
  const kFramesUntilFewer = 10, kFramesUntilMore = 150;
  let share = 0, between_ms = kWanted_ms, frames = 0, frame_ms = 0;
  function watchFrames(isMoving) {
    const now = performance.now(), took_ms = now - frame_ms;
    frame_ms = now;
    if (!isMoving || took_ms > 1000) return;
    between_ms += 0.2 * (took_ms - between_ms);
    ++frames;
    if (frames > kFramesUntilFewer && between_ms > 1.2 * kWanted_ms && share + 1 < kShares.length) ++share;
    else if (frames > kFramesUntilMore && between_ms < 0.6 * kWanted_ms && share > 0) --share;
    else return;
    frames = 0;
  }
  function chooseLevel() {
    const isPresenting = renderer.vr.isPresenting();  // the headset sets the size of its pictures
    const isMoving = isSlow && !isPresenting && performance.now() - moved_ms < kStill_ms;
    watchFrames(isMoving);
    const ratio = fullRatio * (isMoving ? kShares[share] : 1);
    if (!isPresenting && ratio !== renderer.getPixelRatio()) {
      renderer.setPixelRatio(ratio);
      seen.ratio = ratio;
      isDue = true;
    }
    if (isMoving === isCoarse) return;
    isCoarse = isMoving;
    parts.forEach(useLevel);
    isDue = true;
  }

  function showTarget() {
    while (hint.children.length) hint.remove(hint.children[0]);
    hint.visible = Boolean(target);
    if (!target) return;
    const part = parts[target.part];
    if (part && part.surface) hint.add(new THREE.Mesh(part.surface.geometry, hintPaint));
    place(hint, target.pose);
  }

  // The section does not cut the part in hand, as in technical drawings.
  function applyCut() {
    const axis = $("cut").value;
    $("cut-at").hidden = !axis;
    const share = Number($("cut-at").value) / 100;
    if (axis) {
      const normal = new THREE.Vector3(axis === "x" ? 1 : 0, axis === "y" ? 1 : 0, axis === "z" ? -1 : 0);
      if (axis === "x") normal.set(-1, 0, 0);
      root.updateMatrixWorld(true);
      cutPlane.setFromNormalAndCoplanarPoint(normal, normal.clone().multiplyScalar(-share * radius_m));
      cutPlane.applyMatrix4(root.matrixWorld);
    }
    parts.forEach(function (part, index) {
      const isCut = Boolean(axis) && index !== inHand;
      part.paint.clippingPlanes = isCut ? [cutPlane] : null;
      part.inside.clippingPlanes = isCut ? [cutPlane] : null;
      part.paint.side = isCut ? THREE.FrontSide : THREE.DoubleSide;
      part.paint.needsUpdate = part.inside.needsUpdate = true;
      for (const shape of [part.coarse, part.fine]) if (shape && shape.back) shape.back.visible = isCut;
    });
    redraw();
  }

  // ---- forces and contacts

  const marks = new THREE.Group();
  root.add(marks);
  const handArrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1, kForceColor);
  handArrow.visible = false;
  for (const part of [handArrow.line, handArrow.cone]) {  // visible through the parts
    part.material.depthTest = false;
    part.material.transparent = true;
    part.renderOrder = 2;
  }
  marks.add(handArrow);
  const kMostContacts = 256;
  const contactShape = new THREE.BufferGeometry();
  contactShape.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6 * kMostContacts), 3));
  contactShape.setAttribute("color", new THREE.BufferAttribute(new Float32Array(6 * kMostContacts), 3));
  contactShape.setDrawRange(0, 0);
  const contactLines = new THREE.LineSegments(contactShape, new THREE.LineBasicMaterial(
    { vertexColors: THREE.VertexColors, depthTest: false, transparent: true }));
  contactLines.frustumCulled = false;
  contactLines.renderOrder = 2;
  marks.add(contactLines);

  function arrow(object, from, vector, fullScale) {
    const size = vector.length();
    object.visible = size > 1e-3 * fullScale;
    if (!object.visible) return;
    const length = radius_m * Math.min(1.5, 0.6 * size / fullScale) + 0.02 * radius_m;
    object.position.copy(from);
    object.setDirection(vector.clone().normalize());
    object.setLength(length, 0.3 * length, 0.12 * length);
  }

  const kFullForce_N = 15, kFullDepth_um = 20;
  function showContacts(contacts) {
    const places = contactShape.attributes.position.array, colors = contactShape.attributes.color.array;
    const color = new THREE.Color();
    contacts.forEach(function (contact, i) {
      const length = radius_m * (0.05 + 0.3 * Math.min(1, contact.force_N / kFullForce_N));
      for (let k = 0; k < 3; ++k) {
        places[6 * i + k] = contact.p[k];
        places[6 * i + 3 + k] = contact.p[k] + length * contact.n[k];
      }
      color.setHSL(0.33 * (1 - Math.min(1, Math.max(0, contact.depth_um) / kFullDepth_um)), 0.9, 0.42);
      color.toArray(colors, 6 * i);
      color.toArray(colors, 6 * i + 3);
    });
    contactShape.setDrawRange(0, 2 * contacts.length);
    contactShape.attributes.position.needsUpdate = contactShape.attributes.color.needsUpdate = true;
  }

  // ---- snapshots

  let socket = null, clockOffset_ms = null;
  let last = null;  // the newest shown snapshot
  const waiting = [];  // snapshots that are not due yet; all watchers show them at the same instant
  let present_ms = 0;  // time from taking a snapshot to showing it

  // The shortest of the last round trips gives the best estimate of the clock offset.
  const trips = [];
  function hearClock(sent_ms, there_ms) {
    const now_ms = performance.now();
    trips.push({ length_ms: now_ms - sent_ms, offset_ms: there_ms - 0.5 * (sent_ms + now_ms) });
    if (trips.length > 8) trips.shift();
    clockOffset_ms = trips.reduce(function (a, b) { return b.length_ms < a.length_ms ? b : a; }).offset_ms;
  }
  function serverNow_ms() { return performance.now() + (clockOffset_ms || 0); }
  // A person who moves the part sees its motion without this delay.
  function presentAfter_ms() { return isMine() || clockOffset_ms === null ? 0 : present_ms; }
  function isDueNow(shot) {
    return clockOffset_ms === null || shot.taken_ms + presentAfter_ms() <= serverNow_ms();
  }
  function showDue() {
    while (waiting.length > 0 && isDueNow(waiting[0])) show(waiting.shift());
  }
  const kBlowKind = 2;
  const kRoles = ["waiting", "in hand", "released", "mounted"];

  function decode(buffer) {
    const view = new DataView(buffer);
    let at = 1;  // the first byte is the kind of message
    function u8() { return view.getUint8(at++); }
    function u16() { at += 2; return view.getUint16(at - 2, true); }
    function u32() { at += 4; return view.getUint32(at - 4, true); }
    function f32() { at += 4; return view.getFloat32(at - 4, true); }
    function f64() { at += 8; return view.getFloat64(at - 8, true); }
    function floats(count) { const all = []; for (let i = 0; i < count; ++i) all.push(f32()); return all; }
    const shot = { number: u32(), time_s: f64(), taken_ms: f64(), step: (u16() << 16) >> 16 };
    const flags = u8();
    shot.isWhole = Boolean(flags & 4);
    shot.bodies = [];
    for (let left = u16(); left > 0; --left) shot.bodies.push({ part: u16(), role: u8(), pose: floats(7) });
    if (flags & 1) shot.target = { part: u16(), pose: floats(7) };
    if (flags & 2) shot.hand = { pose: floats(7), force: floats(3), torque: floats(3) };
    shot.contacts = [];
    for (let left = u16(); left > 0; --left) {
      const p = floats(3);
      const n = [view.getInt8(at) / 127, view.getInt8(at + 1) / 127, view.getInt8(at + 2) / 127];
      at += 3;
      shot.contacts.push({ p: p, n: n, depth_um: f32(), force_N: f32() });
    }
    return shot;
  }

  function show(shot) {
    last = shot;
    ++seen.snapshots;
    seen.time_s = shot.time_s;
    if (!scene) return;
    if (shot.isWhole) {
      seen.bodies = {};
      parts.forEach(function (part, index) { part.group.visible = scene.parts[index].fixed; });
    }
    for (const body of shot.bodies) {
      const part = parts[body.part];
      if (!part) continue;
      if (body.role === 255) delete seen.bodies[body.part];
      else seen.bodies[body.part] = { role: kRoles[body.role], pose: body.pose };
      part.group.visible = body.role !== 255 && (body.role !== 0 || scene.parts[body.part].fixed);
      place(part.group, body.pose);
    }
    let isChanged = shot.isWhole || shot.bodies.length > 0 || hasNewMarks(shot);
    let held = -1;
    for (const index in seen.bodies) if (seen.bodies[index].role === "in hand") held = Number(index);
    if (held !== inHand) {
      if (parts[inHand]) paintPart(parts[inHand], false);
      if (parts[held]) paintPart(parts[held], true);
      inHand = held;
      isChanged = true;
      applyCut();
    }
    const isNewTarget = Boolean(shot.target) !== Boolean(target) ||
      (shot.target && (shot.target.part !== target.part || shot.target.pose.join() !== target.pose.join()));
    if (isNewTarget) {
      target = shot.target || null;
      isChanged = true;
      showTarget();
    }
    const hasForce = Boolean(shot.hand) && $("forces").getAttribute("aria-pressed") === "true";
    if (hasForce)
      arrow(handArrow, new THREE.Vector3().fromArray(shot.hand.pose), new THREE.Vector3().fromArray(shot.hand.force), kFullForce_N);
    else handArrow.visible = false;
    showContacts($("forces").getAttribute("aria-pressed") === "true" ? shot.contacts : []);
    const step = scene.steps[shot.step];
    $("step").textContent = shot.time_s.toFixed(2) + " s" +
      (step ? " · step " + (shot.step + 1) + " of " + scene.steps.length + ": " + step.name : "");
    const force = shot.hand ? new THREE.Vector3().fromArray(shot.hand.force).length() : 0;
    showTime(shot.time_s);
    $("force").textContent = shot.hand ? force.toFixed(1) + " N on the hand · " + shot.contacts.length + " contacts" : "";
    if (isChanged) redraw();
  }
  // Draws the arrow of the force and the contacts.
  let lastMarks = "";
  function hasNewMarks(shot) {
    const marks = JSON.stringify([shot.hand, shot.contacts, isPressed("forces")]);
    const isNew = marks !== lastMarks;
    lastMarks = marks;
    return isNew;
  }

  // ---- other browsers

  const pointers = {};
  const kPointerColors = [0xd7263d, 0xf46036, 0x1b998b, 0xc5a100, 0x6a0572];
  function showPointer(pointer) {
    if (!pointers[pointer.who]) {
      const ball = new THREE.Mesh(new THREE.SphereBufferGeometry(1, 20, 14), new THREE.MeshBasicMaterial(
        { color: kPointerColors[pointer.who % kPointerColors.length], depthTest: false, transparent: true, opacity: 0.85 }));
      ball.renderOrder = 3;
      root.add(ball);
      pointers[pointer.who] = ball;
    }
    const ball = pointers[pointer.who];
    ball.visible = Boolean(pointer.p);
    seen.pointers[pointer.who] = pointer.p;
    if (pointer.p) ball.position.fromArray(pointer.p).sub(center);
    ball.scale.setScalar(0.025 * radius_m);
    redraw();
  }

  function showHand(hand) {
    seen.hand = hand;
    const button = $("take"), isMine = hand.holder === seen.you && seen.you !== 0;
    button.hidden = !hand.may_take;
    button.disabled = hand.holder !== 0 && !isMine;
    button.setAttribute("aria-pressed", String(isMine));
    button.textContent = isMine ? "Let go" : hand.holder !== 0 ? "Browser " + hand.holder + " holds the part" : "Take the part";
    if (!isMine) endGrab();
  }

  function tell(news) {
    const item = document.createElement("li");
    item.textContent = (news.time_s ? news.time_s.toFixed(2) + " s  " : "") + news.text;
    $("news").appendChild(item);
    while ($("news").children.length > 50) $("news").removeChild($("news").firstChild);
    $("news").scrollTop = $("news").scrollHeight;
    if (news.verdict) {
      $("verdict").textContent = news.text;
      $("verdict").className = news.verdict.replace(" ", "_");
    }
  }

  // ---- a recording

  let playback = null, isScrubbing = false;
  function showPlayback(state) {
    playback = seen.playback = state;
    $("player").hidden = !state;
    if (state) $("play").textContent = state.is_playing ? "Pause" : "Play";
  }
  function showTime(time_s) {
    if (!playback) return;
    const length_s = playback.end_s - playback.begin_s;
    if (!isScrubbing) $("at").value = length_s > 0 ? 1000 * (time_s - playback.begin_s) / length_s : 0;
    $("at-text").textContent = time_s.toFixed(1) + " of " + playback.end_s.toFixed(1) + " s";
  }
  let nextSeek = 0, lateSeek = 0;
  function seek() {
    clearTimeout(lateSeek);
    if (performance.now() < nextSeek) {  // only the last place of the slider counts
      lateSeek = setTimeout(seek, 40);
      return;
    }
    nextSeek = performance.now() + 30;
    send({ seek: playback.begin_s + (playback.end_s - playback.begin_s) * Number($("at").value) / 1000 });
  }

  // ---- sound

  let audio = null, ear = null;
  function openAudio() {
    audio = new (window.AudioContext || window.webkitAudioContext)();
    ear = audio.createDynamicsCompressor();
    ear.connect(audio.destination);
  }
  // Plays an impact that the server synthesised: f64 time, u32 rate, f32 pressure of the value 32767, i16 samples.
  // The impact is heard when its snapshot is shown.
  function playBlow(buffer) {
    ++seen.blows;
    if (!audio || audio.state !== "running") return;
    const kHead = 17, view = new DataView(buffer), count = (buffer.byteLength - kHead) / 2, kFull_Pa = 0.5;
    const samples = audio.createBuffer(1, count, view.getUint32(9, true));
    const data = samples.getChannelData(0), scale = view.getFloat32(13, true) / (32767 * kFull_Pa);
    for (let i = 0; i < count; ++i) data[i] = Math.max(-1, Math.min(1, scale * view.getInt16(kHead + 2 * i, true)));
    const wait_s = 1e-3 * (view.getFloat64(1, true) + presentAfter_ms() - serverNow_ms());
    const latency_s = audio.outputLatency || audio.baseLatency || 0;
    const when_s = audio.currentTime + Math.max(0, wait_s - latency_s);
    // Time of the sound after its snapshot was taken, by the server's clock.
    seen.heardAfter_ms.push(1e3 * (when_s - audio.currentTime + latency_s - wait_s) + presentAfter_ms());
    const source = audio.createBufferSource();
    source.buffer = samples;
    source.connect(ear);
    source.start(when_s);
  }

  // ---- the connection

  function send(message) {
    if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
  }
  const kHear = {
    hello: function (hello) {
      seen.you = hello.you;
      present_ms = hello.present_ms;
      waiting.length = 0;  // removes snapshots of the previous run
      if (hello.run) begin(hello);
    },
    doing: function (words) { $("doing").textContent = words; },
    news: tell,
    pointer: showPointer,
    hand: showHand,
    playback: showPlayback,
    watchers: function (count) { seen.watchers = count; }
  };
  function connect() {
    socket = new WebSocket((window.location.protocol === "https:" ? "wss://" : "ws://") + window.location.host + "/run");
    socket.binaryType = "arraybuffer";
    socket.onmessage = function (event) {
      if (typeof event.data !== "string") {
        if (new Uint8Array(event.data)[0] === kBlowKind) return playBlow(event.data);
        waiting.push(decode(event.data));
        if (document.hidden) showDue();  // a hidden page draws no frames
        return;
      }
      const message = JSON.parse(event.data);
      if (message.pong !== undefined)
        hearClock(message.pong, message.now_ms);
      for (const key in message) if (kHear[key]) kHear[key](message[key]);
    };
    socket.onclose = function () {
      $("doing").textContent = "the connection was lost";
      setTimeout(connect, 1000);
    };
    socket.onopen = function () {
      $("news").textContent = "";
      send({ ping: performance.now() });
      if (isPressed("sound")) send({ sound: 1 });
    };
  }
  setInterval(function () { send({ ping: performance.now() }); }, 2000);

  function showAge() {
    const ages = seen.ages_ms.slice().sort(function (a, b) { return a - b; });
    const age = ages.length ? ages[Math.floor(ages.length / 2)].toFixed(0) + " ms from physics to picture · " : "";
    $("link").textContent = age + (seen.watchers || 0) + " watching · you are browser " + seen.you;
  }
  setInterval(showAge, 1000);

  let acked = 0;
  function draw() {
    showDue();
    updateGrabInHeadset();
    chooseLevel();
    const isNew = last && last.number !== acked, isDrawn = isDue || renderer.vr.isPresenting();
    if (isDrawn) {
      isDue = false;
      lamp.position.copy(camera.position);
      renderer.render(world, camera);
    }
    if (!isNew) return;
    acked = last.number;
    send({ ack: acked });
    if (!isDrawn) return;  // the picture did not change
    ++seen.drawn;
    if (clockOffset_ms === null) return;
    seen.ages_ms.push(serverNow_ms() - last.taken_ms);
    seen.shown.push([last.taken_ms, serverNow_ms()]);
    for (const list of [seen.ages_ms, seen.shown]) if (list.length > 120) list.shift();
  }

  // ---- the hand and the pointer, by mouse or finger

  const ray = new THREE.Raycaster();
  const fingers = {};  // by pointerId: x, y
  let grab = null;     // { point: in world units, how: "move" | "turn" }

  function hit(x, y) {
    const box = canvas.getBoundingClientRect();
    ray.setFromCamera({ x: 2 * (x - box.left) / box.width - 1, y: 1 - 2 * (y - box.top) / box.height }, camera);
    return hitAlongRay();
  }
  function hitAlongRay() {
    const surfaces = parts.filter(function (part) { return part.group.visible && part.surface; })
      .map(function (part) { return part.surface; });
    root.updateMatrixWorld(true);
    for (const found of ray.intersectObjects(surfaces)) {
      const index = parts.findIndex(function (part) { return part.surface === found.object; });
      const planes = parts[index].paint.clippingPlanes;
      if (planes && planes[0].distanceToPoint(found.point) < 0) continue;
      return { part: index, point: found.point };
    }
    return null;
  }
  // Converts world units to metres in the scene's frame.
  function inScene(point) {
    return root.worldToLocal(point.clone()).add(center);
  }
  function vectorInScene(way) {
    return way.clone().applyQuaternion(root.quaternion.clone().inverse()).divideScalar(root.scale.x);
  }
  // Target pose of a step's part, in the form of seen.bodies' poses.
  seen.targetOf = function (step) { return centered(scene.steps[step].target); };
  // Position of a part's centre on the page, in pixels.
  seen.placeOf = function (index) {
    const part = parts[index];
    if (!part || !part.surface) return null;
    root.updateMatrixWorld(true);
    camera.updateMatrixWorld(true);
    part.surface.geometry.computeBoundingBox();
    const middle = part.surface.geometry.boundingBox.getCenter(new THREE.Vector3());
    const at = part.surface.localToWorld(middle).project(camera), box = canvas.getBoundingClientRect();
    return [box.left + 0.5 * box.width * (1 + at.x), box.top + 0.5 * box.height * (1 - at.y)];
  };
  // Pixels of the page per metre of the scene, in the centre of the view.
  seen.pixelsPerMetre = function () {
    const away = camera.position.distanceTo(controls.target);
    return kScreenScale * canvas.getBoundingClientRect().height / (2 * away * Math.tan(0.5 * camera.fov * Math.PI / 180));
  };
  function isMine() { return Boolean(seen.hand) && seen.you !== 0 && seen.hand.holder === seen.you; }
  function isPressed(id) { return $(id).getAttribute("aria-pressed") === "true"; }

  function endGrab() {
    if (grab) send({ drop: null });
    grab = null;
    controls.enabled = true;
  }

  canvas.addEventListener("pointerdown", function (event) {
    canvas.focus();
    fingers[event.pointerId] = { x: event.clientX, y: event.clientY };
    if (grab) return;
    const found = hit(event.clientX, event.clientY);
    if (isMine() && found && found.part === inHand) {
      controls.enabled = false;
      canvas.setPointerCapture(event.pointerId);
      grab = { point: found.point, isTurn: event.button === 2 };
      send({ grab: inScene(found.point).toArray() });
    } else if (isPressed("point")) {
      controls.enabled = false;
      pointAt(event);
    }
  }, true);

  let nextPoint = 0;
  function pointAt(event) {
    if (performance.now() < nextPoint) return;
    nextPoint = performance.now() + 30;
    const found = hit(event.clientX, event.clientY);
    send({ point: found ? inScene(found.point).toArray() : null });
  }

  canvas.addEventListener("pointermove", function (event) {
    const finger = fingers[event.pointerId];
    if (!finger) {
      if (isPressed("point") && event.pointerType === "mouse") pointAt(event);
      return;
    }
    const count = Object.keys(fingers).length;
    const dx = (event.clientX - finger.x) / count, dy = (event.clientY - finger.y) / count;
    finger.x = event.clientX;
    finger.y = event.clientY;
    if (!grab) {
      if (isPressed("point")) pointAt(event);
      return;
    }
    // Two fingers turn the part, as the right button does; with Shift a drag moves in depth, or twists.
    if (grab.isTurn || count > 1) {
      const angle = Math.PI / stage.clientHeight;
      const turn = event.shiftKey ? new THREE.Vector3(0, 0, -angle * dx) : new THREE.Vector3(angle * dy, angle * dx, 0);
      send({ turn: vectorInScene(turn.applyQuaternion(camera.quaternion)).multiplyScalar(root.scale.x).toArray() });
      return;
    }
    const away = grab.point.clone().applyMatrix4(camera.matrixWorldInverse).z;
    const perPixel = -2 * away * Math.tan(0.5 * camera.fov * Math.PI / 180) / stage.clientHeight;
    if (event.shiftKey) return moveGrab(camera.position.clone().sub(grab.point).normalize().multiplyScalar(perPixel * dy));
    moveGrab(new THREE.Vector3(perPixel * dx, -perPixel * dy, 0).applyQuaternion(camera.quaternion));
  });
  function moveGrab(way) {
    grab.point.add(way);
    send({ move: vectorInScene(way).toArray() });
  }
  function lift(event) {
    delete fingers[event.pointerId];
    if (Object.keys(fingers).length) return;
    if (grab) endGrab();
    controls.enabled = true;
  }
  canvas.addEventListener("pointerup", lift);
  canvas.addEventListener("pointercancel", lift);
  canvas.addEventListener("contextmenu", function (event) { event.preventDefault(); });
  canvas.addEventListener("wheel", function (event) {
    if (!grab) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    moveGrab(camera.position.clone().sub(grab.point).normalize()
      .multiplyScalar(-Math.sign(event.deltaY) * 0.02 * radius_m * root.scale.x));
  }, { capture: true, passive: false });

  // ---- a headset

  // The scene stands on a table in front of the viewer, upright and 0.6 m wide.
  function setForHeadset(isOn) {
    if (isOn) {
      root.scale.setScalar(0.3 / radius_m);
      root.rotation.set(-0.5 * Math.PI, 0, 0);
      root.position.set(0, 1.1, -0.8);
    } else {
      root.scale.setScalar(kScreenScale);
      root.rotation.set(0, 0, 0);
      root.position.set(0, 0, 0);
    }
    applyCut();
    if (!isOn) look($("looks").value);
  }
  let held = null;  // pose of the controller that holds the part, when it grabbed the part
  const controller = renderer.vr.getController(0);
  controller.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 0, -3)]),
    new THREE.LineBasicMaterial({ color: kInHand })));
  world.add(controller);
  controller.addEventListener("selectstart", function () {
    controller.updateMatrixWorld(true);
    ray.ray.origin.setFromMatrixPosition(controller.matrixWorld);
    ray.ray.direction.set(0, 0, -1).transformDirection(controller.matrixWorld);
    const found = hitAlongRay();
    if (!found) return send({ point: null });
    if (!isMine() || found.part !== inHand) return send({ point: inScene(found.point).toArray() });
    grab = { point: found.point, isTurn: false };
    held = { p: new THREE.Vector3().setFromMatrixPosition(controller.matrixWorld), q: new THREE.Quaternion().setFromRotationMatrix(controller.matrixWorld) };
    send({ grab: inScene(found.point).toArray() });
  });
  controller.addEventListener("selectend", function () {
    held = null;
    endGrab();
  });
  let nextHeld = 0;
  function updateGrabInHeadset() {
    if (!held || !grab || performance.now() < nextHeld) return;
    nextHeld = performance.now() + 15;
    controller.updateMatrixWorld(true);
    const p = new THREE.Vector3().setFromMatrixPosition(controller.matrixWorld);
    const q = new THREE.Quaternion().setFromRotationMatrix(controller.matrixWorld);
    moveGrab(p.clone().sub(held.p));
    const change = q.clone().multiply(held.q.clone().inverse());
    const sine = Math.sqrt(change.x * change.x + change.y * change.y + change.z * change.z);
    if (sine > 1e-6) {
      const angle = 2 * Math.atan2(sine, change.w) / sine;
      const turn = new THREE.Vector3(angle * change.x, angle * change.y, angle * change.z);
      send({ turn: vectorInScene(turn).multiplyScalar(root.scale.x).toArray() });
    }
    held = { p: p, q: q };
  }

  const headset = $("headset");
  let session = null;
  if (navigator.xr && navigator.xr.isSessionSupported)
    navigator.xr.isSessionSupported("immersive-vr").then(function (isThere) { headset.hidden = !isThere; }).catch(function () {});
  headset.addEventListener("click", function () {
    if (session) return session.end();
    navigator.xr.requestSession("immersive-vr", { optionalFeatures: ["local-floor"] }).then(function (begun) {
      session = begun;
      session.addEventListener("end", function () {
        session = null;
        renderer.vr.enabled = false;
        headset.textContent = "Headset";
        setForHeadset(false);
      });
      renderer.vr.enabled = true;
      renderer.vr.setSession(session);
      headset.textContent = "Leave headset";
      setForHeadset(true);
    }).catch(function (error) { tell({ text: "the headset cannot be used: " + error.message }); });
  });

  // ---- tools

  function toggle(id, then) {
    $(id).addEventListener("click", function () {
      $(id).setAttribute("aria-pressed", String(!isPressed(id)));
      then(isPressed(id));
    });
  }
  $("looks").addEventListener("change", function () { look($("looks").value); });
  $("cut").addEventListener("change", applyCut);
  $("cut-at").addEventListener("input", applyCut);
  toggle("forces", function () { if (last) show(Object.assign({}, last, { bodies: [], isWhole: false })); });
  toggle("sound", function (isOn) {
    send({ sound: isOn ? 1 : 0 });
    if (!audio) openAudio();
    if (isOn) audio.resume();
    else audio.suspend();
  });
  toggle("point", function (isOn) { if (!isOn) send({ point: null }); });
  $("play").addEventListener("click", function () { send({ play: playback && playback.is_playing ? 0 : 1 }); });
  $("at").addEventListener("input", function () { isScrubbing = true; seek(); });
  $("at").addEventListener("change", function () { seek(); isScrubbing = false; });
  $("take").addEventListener("click", function () { send(isMine() ? { leave: null } : { take: null }); });

  resize();
  look("corner");
  renderer.setAnimationLoop(draw);
  connect();
})();

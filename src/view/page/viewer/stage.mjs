// SPDX-License-Identifier: GPL-3.0-or-later
// Scene, camera, shaders, and the way a big mesh is drawn on a slow machine: cards while the view moves, then the real faces,
// a slice at a time, into a picture of their own that is shown when it is whole.
import {
  BufferAttribute, BufferGeometry, DataTexture, DoubleSide, FrontSide, Box3, Frustum, LinearFilter, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  OrthographicCamera, PerspectiveCamera, PlaneGeometry, RGBAFormat, Scene, ShaderMaterial, Vector2, Vector3, Vector4, WebGLRenderer, WebGLRenderTarget,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { light_on } from "./paint.mjs";

const idle_ms = 160;
const slice_ms = 140;
const field_deg = 28;

const place = `
  uniform float thickness, gap, middle;
  uniform vec4 clip;
  varying float beyond;
  vec4 place(vec3 p, float rank) {
    beyond = dot(clip.xyz, p) - clip.w;
    return projectionMatrix * modelViewMatrix * vec4(p.xy, p.z * thickness + (rank - middle) * gap, 1.0);
  }`;
// Faces of cells are seen from either side: from inside what is shown, where a section opens it, they are the cut.
const vertex_shader = `
  #ifdef TWO_SIDES
    attribute vec4 back;
    varying vec3 behind;
    varying float is_cut;
  #endif
  attribute vec4 colour, corner;
  varying vec3 tint;
  varying vec3 inner;
  ${place}
  void main() {
    tint = colour.rgb;
    inner = corner.rgb;
    #ifdef TWO_SIDES
      behind = back.rgb;
      is_cut = 1.0 - colour.a;
    #endif
    gl_Position = place(position, corner.a * 255.0);
  }`;
const fragment_shader = `
  varying vec3 tint, inner;
  varying float beyond;
  uniform vec3 edge_colour;
  #ifdef TWO_SIDES
    varying vec3 behind;
    varying float is_cut;
    uniform float cut_light;
  #endif
  void main() {
    if (beyond > 0.0) discard;
    vec3 c = tint;
    #ifdef TWO_SIDES
      if (!gl_FrontFacing || is_cut > 0.5) {
        gl_FragColor = vec4((gl_FrontFacing ? tint : behind) * cut_light, 1.0);
        return;
      }
    #endif
    #ifdef EDGES
      vec3 pace = max(fwidth(inner), vec3(1e-6));
      vec3 pixels = inner / pace;
      float nearest = min(min(pixels.x, pixels.y), pixels.z);
      // Cells of a few pixels have no edges, or fine regions would turn black.
      float size = 1.0 / max(max(pace.x, pace.y), pace.z);
      float strength = 0.55 * clamp((size - 3.0) / 9.0, 0.0, 1.0);
      c = mix(c, edge_colour, strength * (1.0 - smoothstep(0.25, 0.95, nearest)));
    #endif
    gl_FragColor = vec4(c, 1.0);
  }`;
const card_vertex_shader = `
  uniform float level, rank;
  varying vec2 at;
  ${place}
  void main() {
    at = uv;
    gl_Position = place(vec3(position.xy, level), rank);
  }`;
const card_fragment_shader = `
  uniform sampler2D picture;
  varying vec2 at;
  varying float beyond;
  void main() {
    vec4 c = texture2D(picture, at);
    if (beyond > 0.0 || c.a < 0.5) discard;
    gl_FragColor = vec4(c.rgb / c.a, 1.0);
  }`;

export function has_webgl() {
  return Boolean(document.createElement("canvas").getContext("webgl2"));
}

export class Stage {
  /// @param model  Prisms or Cells
  constructor(canvas, model, on_frame) {
    Object.assign(this, { canvas, model, on_frame });
    const { min_x, min_y, max_x, max_y } = model.box;
    const [low, high] = model.z_range;
    this.centre = [(min_x + max_x) / 2, (min_y + max_y) / 2, (low + high) / 2];
    this.side = Math.max(max_x - min_x, max_y - min_y);
    this.is_software = this.looks_like_software();
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true, powerPreference: "high-performance" });
    this.renderer.setClearColor(0, 0);
    this.renderer.autoClear = false;
    this.renderer.setPixelRatio(Math.min(this.is_software ? 1 : 2, window.devicePixelRatio));
    // Triangles a frame may have, at first by guess, then by the clock.
    this.budget = this.is_software ? 60000 : 4000000;
    this.uniforms = {
      thickness: { value: 1 }, gap: { value: 0 }, middle: { value: 0 }, clip: { value: new Vector4(0, 0, 0, 1) }, edge_colour: { value: new Vector3(0.07, 0.09, 0.11) }, cut_light: { value: 1 },
    };
    const shaders = { uniforms: this.uniforms, vertexShader: vertex_shader, fragmentShader: fragment_shader };
    const sides = model.exact_section ? { defines: {}, side: FrontSide } : { defines: { TWO_SIDES: 1 }, side: DoubleSide };
    this.with_edges = new ShaderMaterial({ ...shaders, ...sides, defines: { ...sides.defines, EDGES: 1 } });
    this.plain = new ShaderMaterial({ ...shaders, ...sides });
    // What the plane lays open is not cut by it.
    const uncut = { ...shaders, uniforms: { ...this.uniforms, clip: { value: new Vector4(0, 0, 0, 1) } }, side: DoubleSide };
    this.cut_with_edges = new ShaderMaterial({ ...uncut, defines: { EDGES: 1 } });
    this.cut_plain = new ShaderMaterial(uncut);
    // Tagged faces come before the faces they lie on.
    this.tag_material = new ShaderMaterial({ ...shaders, defines: { EDGES: 1 }, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -4 });
    this.edges = true;
    this.scene = new Scene(); // the real faces
    this.moving = new Scene(); // cards
    this.always = new Scene(); // section and highlight
    this.camera = new PerspectiveCamera(field_deg, 1, 0.01, 1e5);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    Object.assign(this.controls, { screenSpacePanning: true, zoomToCursor: true, zoomSpeed: 1.4, rotateSpeed: 0.9 });
    this.controls.addEventListener("change", () => this.moved());
    this.screen = new Scene();
    this.screen_camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
    this.target = new WebGLRenderTarget(4, 4, { depthBuffer: true, samples: 4 });
    this.screen.add(new Mesh(new PlaneGeometry(2, 2), new ShaderMaterial({
      uniforms: { picture: { value: this.target.texture } }, depthTest: false, depthWrite: false,
      vertexShader: "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }",
      fragmentShader: "varying vec2 at; uniform sampler2D picture; void main() { gl_FragColor = texture2D(picture, at); }",
    })));
    this.highlight = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0xff2d95, depthTest: false, transparent: true }));
    this.highlight.frustumCulled = false;
    this.highlight.visible = false;
    this.times = {};
    this.stale = new Set();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  looks_like_software() {
    const gl = document.createElement("canvas").getContext("webgl2");
    const info = gl?.getExtension("WEBGL_debug_renderer_info");
    const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
    gl?.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|software|basic render/i.test(name);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.target.setSize(this.canvas.width, this.canvas.height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.moved();
  }

  // ---- what is shown

  /// Faces anew: after toggles, colours or the first step of exploding.
  show(hidden, paint, is_exploded) {
    this.visibility = this.model.visibility(hidden, is_exploded);
    this.paint = paint;
    this.uniforms.middle.value = (this.visibility.num_ranks - 1) / 2;
    this.stale = new Set(["cards", "rim", "faces", "section", "tags"]);
    this.moved();
  }

  /// The real faces are made when they are first drawn: the cards can show before.
  need_faces() {
    if (!this.stale.has("faces")) return;
    this.stale.delete("faces");
    const arrays = this.model.build(this.visibility, this.paint, this.centre, Boolean(this.plane));
    this.ranges = arrays.ranges;
    this.num_faces = arrays.num_faces;
    this.per_side = arrays.per_side;
    this.faces?.geometry.dispose();
    if (this.faces) this.scene.remove(this.faces);
    this.faces = this.new_mesh(arrays, [this.edges ? this.with_edges : this.plain]);
    this.scene.add(this.faces);
  }
  need_rim() {
    if (!this.stale.has("rim")) return;
    this.stale.delete("rim");
    if (this.rim) {
      this.moving.remove(this.rim);
      this.rim.geometry.dispose();
    }
    this.rim = this.new_mesh(this.model.build_rim(this.visibility, this.paint, this.centre), this.plain);
    this.moving.add(this.rim);
  }
  need_section() {
    if (!this.stale.has("section")) return;
    this.stale.delete("section");
    if (this.cut) {
      this.always.remove(this.cut);
      this.cut.geometry.dispose();
      this.cut = null;
    }
    if (!this.plane || !this.model.exact_section) return;
    this.cut = this.new_mesh(this.model.build_section(this.visibility, this.paint, this.centre, this.plane), this.edges ? this.cut_with_edges : this.cut_plain);
    this.always.add(this.cut);
  }
  /// Face tags drawn over everything else in their place. wanted: flag per tag; colours: [r, g, b] per tag.
  show_tags(wanted, colours) {
    this.wanted_tags = { wanted: [...wanted], colours };
    this.stale.add("tags");
    this.moved();
  }
  need_tags() {
    if (!this.stale.has("tags") || !this.wanted_tags) return;
    this.stale.delete("tags");
    if (this.tagged) {
      this.always.remove(this.tagged);
      this.tagged.geometry.dispose();
      this.tagged = null;
    }
    if (!this.wanted_tags.wanted.some(Boolean)) return;
    this.tagged = this.new_mesh(this.model.build_tagged(this.visibility, this.wanted_tags.wanted, this.wanted_tags.colours, this.centre, Boolean(this.plane)), this.tag_material);
    this.always.add(this.tagged);
  }
  new_mesh({ position, colour, corner, back }, material) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(position, 3));
    geometry.setAttribute("colour", new BufferAttribute(colour, 4, true));
    geometry.setAttribute("corner", new BufferAttribute(corner, 4, true));
    if (back) geometry.setAttribute("back", new BufferAttribute(back, 4, true));
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    return mesh;
  }
  need_cards() {
    if (!this.stale.has("cards")) return;
    this.stale.delete("cards");
    for (const card of this.cards ?? []) {
      this.moving.remove(card);
      card.material.uniforms.picture.value.dispose();
      card.material.dispose();
    }
    this.cards = [];
    this.card_maker ??= this.model.cards();
    this.card_sides = new Set();
  }
  /// Cards of the side the camera is on; the other side is made when it is first seen.
  need_card_side(kind) {
    this.need_cards();
    if (this.card_sides.has(kind)) return;
    this.card_sides.add(kind);
    const { min_x, min_y, max_x, max_y } = this.model.box;
    const { width, height } = this.card_maker;
    this.card_plane ??= new PlaneGeometry(max_x - min_x, max_y - min_y);
    for (let s = 0; s < this.model.num_slabs; ++s) {
      const pixels = this.card_maker.draw(kind, s, this.visibility, this.paint);
      if (!pixels) continue;
      const picture = new DataTexture(pixels, width, height, RGBAFormat);
      picture.minFilter = picture.magFilter = LinearFilter;
      picture.needsUpdate = true;
      const z = this.model.slab_z[s + (kind === "up" ? 1 : 0)] - this.centre[2];
      const material = new ShaderMaterial({
        uniforms: { ...this.uniforms, picture: { value: picture }, level: { value: z }, rank: { value: this.visibility.rank[s] } },
        vertexShader: card_vertex_shader, fragmentShader: card_fragment_shader, side: DoubleSide,
      });
      const card = new Mesh(this.card_plane, material);
      card.frustumCulled = false;
      card.userData.kind = kind;
      this.cards.push(card);
      this.moving.add(card);
    }
  }

  set_edges(on) {
    this.edges = on;
    if (this.faces) this.faces.material = [on ? this.with_edges : this.plain];
    this.stale.add("section");
    this.moved();
  }
  set_thickness(scale) {
    const was_fitted = this.is_fitted();
    this.uniforms.thickness.value = scale;
    if (was_fitted) this.fit();
    this.moved();
  }
  /// amount: gap in tenths of the larger side.
  set_explode(amount) {
    const was_fitted = this.is_fitted();
    this.uniforms.gap.value = (amount * this.side) / 10;
    if (was_fitted) this.fit();
    this.moved();
  }
  set_section(plane) {
    // Without cells inside the groups, the faces between them show where the plane opens them.
    if (!this.model.exact_section && Boolean(plane) !== Boolean(this.plane)) this.stale = this.stale.add("faces").add("tags");
    this.plane = plane;
    this.set_clip();
    this.stale.add("section");
    this.moved();
  }
  set_clip() {
    const clip = this.uniforms.clip.value;
    if (!this.plane) clip.set(0, 0, 0, 1);
    else {
      const sign = this.plane.keep_above ? -1 : 1;
      const normal = [0, 0, 0];
      normal[this.plane.axis] = sign;
      this.uniforms.cut_light.value = light_on(...normal);
      clip.set(...normal, sign * (this.plane.at + 3.7e-8 - this.centre[this.plane.axis]));
    }
  }
  set_edge_colour(r, g, b) {
    this.uniforms.edge_colour.value.set(r, g, b);
    this.moved();
  }

  // ---- camera

  height() {
    const [low, high] = this.model.z_range;
    return (high - low) * this.uniforms.thickness.value + (this.visibility.num_ranks - 1) * this.uniforms.gap.value;
  }
  /// z on the stage of a mesh coordinate in a storey.
  lift(z, slab) {
    return (z - this.centre[2]) * this.uniforms.thickness.value + this.offset(slab);
  }
  /// How far a storey is moved by the explosion; the middle one stays.
  offset(slab) {
    return (this.visibility.rank[slab] - this.uniforms.middle.value) * this.uniforms.gap.value;
  }
  /// Lowest and highest z of the whole mesh on the stage.
  ends() {
    const [low, high] = this.model.z_range;
    return [this.lift(low, 0), this.lift(high, this.model.num_storeys - 1)];
  }
  /// Corners of the box around all that is shown, on the stage.
  shown_box() {
    const { storeys, min_x, min_y, max_x, max_y } = this.model.extent(this.visibility);
    let low = Infinity, high = -Infinity;
    for (const s of storeys) {
      low = Math.min(low, this.lift(s.low, s.storey));
      high = Math.max(high, this.lift(s.high, s.storey));
    }
    if (low > high) low = high = 0;
    return new Box3(new Vector3(min_x - this.centre[0], min_y - this.centre[1], low), new Vector3(max_x - this.centre[0], max_y - this.centre[1], high));
  }
  /// Everything in view from a direction; angles as in pcbmesh render.
  look_from(azimuth_deg, elevation_deg) {
    const a = (azimuth_deg * Math.PI) / 180, e = (Math.min(89.99, Math.max(-89.99, elevation_deg)) * Math.PI) / 180;
    this.fit(new Vector3(Math.sin(a) * Math.cos(e), -Math.cos(a) * Math.cos(e), Math.sin(e)));
  }
  fit(direction) {
    const box = this.shown_box(), middle = box.getCenter(new Vector3());
    const towards = (direction ?? this.camera.position.clone().sub(this.controls.target)).normalize();
    this.camera.position.copy(middle).addScaledVector(towards, 1);
    this.camera.lookAt(middle);
    this.camera.updateMatrixWorld();
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0), up = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    const tan = Math.tan((field_deg * Math.PI) / 360) * 0.93;
    let distance = 0;
    for (let i = 0; i < 8; ++i) {
      const p = new Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).sub(middle);
      distance = Math.max(distance, p.dot(towards) + Math.max(Math.abs(p.dot(up)) / tan, Math.abs(p.dot(right)) / (tan * this.camera.aspect)));
    }
    this.camera.position.copy(middle).addScaledVector(towards, distance);
    this.controls.target.copy(middle);
    this.controls.update();
    this.fitted_distance = distance;
    this.moved();
  }
  /// Nobody has zoomed since everything was last brought into view.
  is_fitted() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return Math.abs(distance - (this.fitted_distance ?? 0)) < 1e-6 * distance;
  }
  /// Near a place: mesh coordinates in mm, slab for the explosion, and how many mm should fill the view.
  fly_to(p, slab, span) {
    const target = new Vector3(p[0] - this.centre[0], p[1] - this.centre[1], this.lift(p[2], slab));
    const towards = this.camera.position.clone().sub(this.controls.target).normalize();
    if (towards.z < 0.35) towards.set(towards.x, towards.y, 0.6).normalize();
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(towards, span / (2 * Math.tan((field_deg * Math.PI) / 360)));
    this.controls.update();
    this.moved();
  }
  rotate(yaw, pitch) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const radius = offset.length();
    const azimuth = Math.atan2(offset.x, -offset.y) + yaw, elevation = Math.min(1.5706, Math.max(-1.5706, Math.asin(offset.z / radius) + pitch));
    offset.set(Math.sin(azimuth) * Math.cos(elevation), -Math.cos(azimuth) * Math.cos(elevation), Math.sin(elevation)).multiplyScalar(radius);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.moved();
  }
  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(1 / factor).add(this.controls.target);
    this.controls.update();
    this.moved();
  }
  pan(dx, dy) {
    const distance = this.camera.position.distanceTo(this.controls.target) * Math.tan((field_deg * Math.PI) / 360);
    const right = new Vector3().setFromMatrixColumn(this.camera.matrix, 0), up = new Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    const by = right.multiplyScalar(dx * distance).addScaledVector(up, dy * distance);
    this.camera.position.add(by);
    this.controls.target.add(by);
    this.controls.update();
    this.moved();
  }
  /// The camera stands on the side of lower coordinates.
  looks_from_below(axis) {
    return this.camera.position.getComponent(axis) < this.controls.target.getComponent(axis);
  }
  angles() {
    const offset = this.camera.position.clone().sub(this.controls.target);
    return { azimuth_deg: (Math.atan2(offset.x, -offset.y) * 180) / Math.PI, elevation_deg: (Math.asin(offset.z / offset.length()) * 180) / Math.PI };
  }

  // ---- drawing

  moved() {
    this.settled = false;
    this.last_move = performance.now();
    this.generation = (this.generation ?? 0) + 1;
    this.ask_for_frame();
  }
  ask_for_frame() {
    if (!this.frame && !this.drawing) this.frame = requestAnimationFrame(() => this.draw_moving());
  }

  set_clip_distances() {
    const distance = this.camera.position.distanceTo(this.controls.target), reach = this.side + this.height();
    this.camera.near = Math.max(distance * 0.01, distance - 2 * reach);
    this.camera.far = distance + 2 * reach;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  /// Ranges of the tiles in view, of the sides that face the camera.
  ranges_in_view() {
    const frustum = new Frustum().setFromProjectionMatrix(new Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse));
    const { min_x, min_y, max_x, max_y } = this.model.box, n = this.per_side;
    const dx = (max_x - min_x) / n, dy = (max_y - min_y) / n;
    const [low, high] = this.ends();
    // Triangles stick out of their tile by up to the longest edge.
    const out = this.model.size_range[1];
    const in_view = Array.from({ length: n * n }, (_, k) => {
      const x0 = min_x + (k % n) * dx - this.centre[0], y0 = min_y + Math.floor(k / n) * dy - this.centre[1];
      return frustum.intersectsBox(new Box3(new Vector3(x0 - out, y0 - out, low), new Vector3(x0 + dx + out, y0 + dy + out, high)));
    });
    const z = this.camera.position.z;
    return this.ranges.filter((r) => in_view[r.tile] && (r.kind !== "up" || z > low) && (r.kind !== "down" || z < high));
  }
  triangles_of(ranges) {
    return ranges.reduce((sum, r) => sum + r.count / 3, 0);
  }
  /// A rough count before the faces are made.
  looks_small() {
    return this.model.guess_triangles(this.visibility, this.uniforms.gap.value > 0) <= this.budget;
  }

  async draw_moving() {
    if (!this.visibility || this.drawing) {
      this.frame = 0;
      return;
    }
    this.drawing = true;
    this.set_clip_distances();
    this.need_section();
    this.need_tags();
    const generation = this.generation;
    if (this.stale.has("faces") && (!this.model.cards || this.looks_small())) this.need_faces();
    const ranges = this.stale.has("faces") ? null : this.ranges_in_view();
    const fits = ranges && this.triangles_of(ranges) <= this.budget;
    if (fits) {
      const start = performance.now();
      this.renderer.setRenderTarget(null);
      this.renderer.clear();
      this.draw_ranges(ranges);
      this.renderer.render(this.always, this.camera);
      await this.finished();
      this.learn(this.triangles_of(ranges), performance.now() - start);
    } else {
      if (this.model.cards) this.draw_cards();
      else this.draw_largest();
      await this.finished();
      this.times.first_picture ??= performance.now();
    }
    this.on_frame();
    this.drawing = false;
    this.frame = 0;
    if (generation !== this.generation) return this.ask_for_frame();
    if (fits) return this.whole(generation);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.refine(generation), this.times.whole_picture ? idle_ms : 0);
  }
  draw_cards() {
    const z = this.camera.position.z, [low, high] = this.ends();
    if (z > low) this.need_card_side("up");
    if (z < high) this.need_card_side("down");
    this.need_rim();
    for (const card of this.cards) card.visible = card.userData.kind === "up" ? z > low : z < high;
    this.renderer.setRenderTarget(null);
    this.renderer.clear();
    this.renderer.render(this.moving, this.camera);
    this.renderer.render(this.always, this.camera);
  }
  /// The largest faces, as many as there is time for: what is drawn of cells while the view moves.
  draw_largest() {
    const { geometry } = this.faces;
    const count = Math.floor(this.budget / 2);
    if (this.largest?.source !== geometry || this.largest.count < count / 2 || this.largest.count > 2 * count) {
      this.largest?.mesh.geometry.dispose();
      const largest = new BufferGeometry();
      for (const [name, attribute] of Object.entries(geometry.attributes)) largest.setAttribute(name, attribute);
      largest.setIndex(new BufferAttribute(largest_triangles(geometry.attributes.position.array, count), 1));
      this.largest = { source: geometry, count, mesh: new Mesh(largest, this.faces.material[0]) };
      this.largest.mesh.frustumCulled = false;
    }
    this.largest.mesh.material = this.faces.material[0];
    this.moving.clear();
    this.moving.add(this.largest.mesh);
    this.renderer.setRenderTarget(null);
    this.renderer.clear();
    this.renderer.render(this.moving, this.camera);
    this.renderer.render(this.always, this.camera);
  }
  draw_ranges(ranges) {
    const { geometry } = this.faces;
    geometry.clearGroups();
    // Ranges that follow one another are drawn in one go.
    let open = null;
    for (const r of ranges) {
      if (open && open.start + open.count === r.start) open.count += r.count;
      else {
        if (open) geometry.addGroup(open.start, open.count, 0);
        open = { start: r.start, count: r.count };
      }
    }
    if (open) geometry.addGroup(open.start, open.count, 0);
    this.renderer.render(this.scene, this.camera);
  }
  /// Kept when the picture is really drawn, where that takes long enough to matter: a slow machine is never asked for the next
  /// picture before it has finished one.
  async finished() {
    if (!this.is_software) return;
    const gl = this.renderer.getContext();
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    for (let waits = 0; waits < 5000; ++waits) {
      if (gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED || gl.isContextLost()) break;
      await new Promise((resume) => setTimeout(resume, 2));
    }
    gl.deleteSync(fence);
  }
  learn(triangles, ms) {
    if (!this.is_software || triangles < 5000) return;
    const able = (triangles / Math.max(ms, 1)) * slice_ms;
    this.budget = Math.min(400000, Math.max(15000, 0.5 * this.budget + 0.5 * able));
  }
  async refine(generation) {
    if (generation !== this.generation) return;
    this.need_faces();
    const todo = this.ranges_in_view();
    for (let first = true; todo.length > 0 || first; first = false) {
      const slice = [];
      for (let sum = 0; todo.length > 0 && (sum === 0 || sum + todo[0].count / 3 <= this.budget); ) {
        sum += todo[0].count / 3;
        slice.push(todo.shift());
      }
      const start = performance.now();
      this.renderer.setRenderTarget(this.target);
      if (first) this.renderer.clear();
      this.draw_ranges(slice);
      this.renderer.setRenderTarget(null);
      await this.finished();
      this.learn(this.triangles_of(slice), performance.now() - start);
      if (generation !== this.generation) return;
    }
    this.renderer.setRenderTarget(this.target);
    this.renderer.render(this.always, this.camera);
    this.renderer.setRenderTarget(null);
    this.renderer.clear();
    this.renderer.render(this.screen, this.screen_camera);
    await this.finished();
    if (generation === this.generation) this.whole(generation);
  }
  whole(generation) {
    this.times.first_picture ??= performance.now();
    this.times.whole_picture ??= performance.now();
    this.settled = generation === this.generation;
    this.on_frame();
  }

  // ---- places

  /// Pixels of a place on the stage, or null behind the camera.
  project(p, slab) {
    const v = new Vector3(p[0] - this.centre[0], p[1] - this.centre[1], this.lift(p[2], slab)).project(this.camera);
    if (v.z > 1) return null;
    const { clientWidth, clientHeight } = this.canvas;
    return [((v.x + 1) / 2) * clientWidth, ((1 - v.y) / 2) * clientHeight];
  }

  /// What is at a pixel of the canvas, as the mesh tells it, or null.
  pick(px, py) {
    const pointer = new Vector2((px / this.canvas.clientWidth) * 2 - 1, 1 - (py / this.canvas.clientHeight) * 2);
    this.camera.updateMatrixWorld();
    const from = new Vector3().setFromMatrixPosition(this.camera.matrixWorld);
    return this.model.pick(this, from, new Vector3(pointer.x, pointer.y, 0.5).unproject(this.camera).sub(from).normalize());
  }
  /// Part of a ray that the section plane leaves: [s0, s1]; z is measured in the storey as it lies in the mesh.
  kept_part(from, ray, storey) {
    if (!this.plane) return [0, Infinity];
    const { axis, at, keep_above } = this.plane, sign = keep_above ? -1 : 1, thickness = this.uniforms.thickness.value;
    const start = axis === 2 ? (from.z - this.offset(storey)) / thickness + this.centre[2] : from.getComponent(axis) + this.centre[axis];
    const speed = axis === 2 ? ray.z / thickness : ray.getComponent(axis);
    const cross = (at + 3.7e-8 - start) / speed;
    if (sign * speed > 0) return [0, cross];
    if (sign * speed < 0) return [Math.max(0, cross), Infinity];
    return sign * (start - at) > 0 ? [Infinity, 0] : [0, Infinity];
  }

  /// Outlines a described cell, or nothing.
  mark(cell) {
    this.always.remove(this.highlight);
    this.highlight.geometry.dispose();
    if (cell) {
      this.highlight.geometry = new BufferGeometry();
      this.highlight.geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.model.outline(cell, this)), 3));
      this.highlight.visible = true;
      this.always.add(this.highlight);
    }
    this.marked = cell;
    this.moved();
  }
}

/// Indices of the `count` largest of the triangles, three corners each.
function largest_triangles(position, count) {
  const num = position.length / 9, size = new Float32Array(num);
  for (let t = 0, i = 0; t < num; ++t, i += 9) {
    const ux = position[i + 3] - position[i], uy = position[i + 4] - position[i + 1], uz = position[i + 5] - position[i + 2];
    const vx = position[i + 6] - position[i], vy = position[i + 7] - position[i + 1], vz = position[i + 8] - position[i + 2];
    size[t] = Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
  }
  const least = num > count ? size.slice().sort()[num - count] : 0;
  const index = [];
  for (let t = 0; t < num; ++t) if (size[t] >= least) index.push(3 * t, 3 * t + 1, 3 * t + 2);
  return new Uint32Array(index);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Visible faces as vertex arrays: what src/view/skin.cpp does, for the browser.
import { light_on } from "./paint.mjs";

export const kinds = ["up", "down", "wall"];
const most_wall_quads = 300000; // above it the sub-layers of walls are drawn as one

/// Which cells show, and between which a face does.
export class Visibility {
  constructor(prisms, hidden, is_exploded) {
    const { tables, num_slabs } = prisms;
    this.prisms = prisms;
    // Per column and slab: -1 = not there, else a class; faces show between classes.
    this.classes = new Int32Array(prisms.groups.length);
    for (let i = 0; i < this.classes.length; ++i) {
      const group = prisms.groups[i];
      this.classes[i] = group < 0 || hidden[group] ? -1 : is_exploded ? tables.groups[group].layer : 0;
    }
    // Layers are counted where they show: gaps open only between them.
    this.rank = new Int32Array(num_slabs);
    let last = -1, rank = 0;
    for (let s = 0; s < num_slabs; ++s) {
      let used = false;
      for (let c = 0; c < tables.columns.length && !used; ++c) used = this.classes[c * num_slabs + s] >= 0;
      if (used) {
        if (last >= 0 && prisms.layer_of_slab[s] !== last) ++rank;
        last = prisms.layer_of_slab[s];
      }
      this.rank[s] = rank;
    }
    this.num_ranks = rank + 1;
  }
  at(slab, t) {
    if (t < 0 || slab < 0 || slab >= this.prisms.num_slabs) return -1;
    return this.classes[this.prisms.column[t] * this.prisms.num_slabs + slab];
  }
}

class Growing {
  constructor() {
    this.size = 0;
    this.values = new Int32Array(1 << 14);
  }
  push(a, b, c) {
    if (this.size + 3 > this.values.length) {
      const more = new Int32Array(2 * this.values.length);
      more.set(this.values);
      this.values = more;
    }
    this.values[this.size++] = a;
    this.values[this.size++] = b;
    this.values[this.size++] = c;
  }
}

/// Records (slab, triangle, side) by kind; side = -1 for caps.
function collect(prisms, visibility) {
  const { num_slabs, num_triangles, column, neighbour } = prisms;
  const { classes } = visibility;
  const up = new Growing(), down = new Growing(), wall = new Growing();
  for (let f = 0; f <= num_slabs; ++f) {
    for (let t = 0; t < num_triangles; ++t) {
      const base = column[t] * num_slabs;
      const below = f > 0 ? classes[base + f - 1] : -1, above = f < num_slabs ? classes[base + f] : -1;
      if (below === above) continue;
      if (below >= 0) up.push(f - 1, t, -1);
      if (above >= 0) down.push(f, t, -1);
    }
  }
  for (let side = 0; side < neighbour.length; ++side) {
    const t = (side / 3) | 0, u = neighbour[side];
    if (u > t || (u >= 0 && column[u] === column[t])) continue;
    for (let s = 0; s < num_slabs; ++s) {
      const here = classes[column[t] * num_slabs + s], there = u < 0 ? -1 : classes[column[u] * num_slabs + s];
      if (here === there) continue;
      if (here >= 0) wall.push(s, t, side);
      if (there >= 0) {
        let other = 3 * u;
        while (neighbour[other] !== t) ++other;
        wall.push(s, u, other);
      }
    }
  }
  return { up, down, wall };
}

/// Vertex arrays with ranges by kind and tile. Positions are relative to `centre`, so that floats keep their digits.
export function build(prisms, visibility, paint, centre) {
  const { corners, x, y, slab_z } = prisms;
  const found = collect(prisms, visibility);
  const per_side = prisms.num_triangles > 20000 ? 8 : 1, num_tiles = per_side * per_side;
  const { min_x, min_y, max_x, max_y } = prisms.box;
  const tile_of = (t) => {
    const i = Math.min(per_side - 1, (per_side * (x[corners[3 * t]] - min_x)) / (max_x - min_x)) | 0;
    const j = Math.min(per_side - 1, (per_side * (y[corners[3 * t]] - min_y)) / (max_y - min_y)) | 0;
    return j * per_side + i;
  };
  let quads = 0;
  for (let i = 0; i < found.wall.size; i += 3) quads += prisms.num_cuts(found.wall.values[i]);
  const split_walls = quads <= most_wall_quads;
  const cuts_of = (slab) => (split_walls ? prisms.num_cuts(slab) : 1);

  // Count, then place: faces of one tile stand together.
  const ranges = [];
  let num_vertices = 0, num_faces = 0;
  const starts = {};
  for (const kind of kinds) {
    const { values, size } = found[kind];
    const counts = new Int32Array(num_tiles);
    for (let i = 0; i < size; i += 3) counts[tile_of(values[i + 1])] += kind === "wall" ? 6 * cuts_of(values[i]) : 3;
    starts[kind] = new Int32Array(num_tiles);
    for (let tile = 0; tile < num_tiles; ++tile) {
      starts[kind][tile] = num_vertices;
      if (counts[tile] > 0) ranges.push({ kind, tile, start: num_vertices, count: counts[tile] });
      num_vertices += counts[tile];
    }
    num_faces += size / 3;
  }
  const position = new Float32Array(3 * num_vertices), colour = new Uint8Array(4 * num_vertices), corner = new Uint8Array(4 * num_vertices);
  const put = (v, px, py, pz, r, g, b, e0, e1, e2, rank) => {
    position[3 * v] = px - centre[0];
    position[3 * v + 1] = py - centre[1];
    position[3 * v + 2] = pz - centre[2];
    colour[4 * v] = r;
    colour[4 * v + 1] = g;
    colour[4 * v + 2] = b;
    colour[4 * v + 3] = 255;
    corner[4 * v] = e0;
    corner[4 * v + 1] = e1;
    corner[4 * v + 2] = e2;
    corner[4 * v + 3] = rank;
  };
  const on = 255, by_sublayer = paint.mode === "q_p";
  for (const kind of kinds) {
    const { values, size } = found[kind];
    const next = starts[kind];
    const light_cap = kind === "up" ? light_on(0, 0, 1) : light_on(0, 0, -1);
    for (let i = 0; i < size; i += 3) {
      const slab = values[i], t = values[i + 1], side = values[i + 2];
      const tile = tile_of(t), rank = Math.min(255, visibility.rank[slab]);
      let v = next[tile];
      if (kind === "wall") {
        const a = corners[side], b = corners[side % 3 === 2 ? side - 2 : side + 1];
        let [r, g, bl] = paint.face("wall", slab, t, a, b);
        const dx = x[b] - x[a], dy = y[b] - y[a], length = Math.hypot(dx, dy) || 1;
        const light = light_on(dy / length, -dx / length, 0);
        const first = prisms.first_sublayer[slab], cuts = cuts_of(slab), whole = cuts < prisms.num_cuts(slab);
        for (let k = 0; k < cuts; ++k) {
          const z0 = prisms.z[first + k], z1 = whole ? slab_z[slab + 1] : prisms.z[first + k + 1];
          if (by_sublayer && !whole) [r, g, bl] = paint.face("wall", slab, t, a, b, first + k);
          // The diagonal is no edge: the corner opposite to it counts as far away.
          put(v++, x[a], y[a], z0, r * light, g * light, bl * light, on, on, 0, rank);
          put(v++, x[b], y[b], z0, r * light, g * light, bl * light, 0, on, 0, rank);
          put(v++, x[b], y[b], z1, r * light, g * light, bl * light, 0, on, on, rank);
          put(v++, x[a], y[a], z0, r * light, g * light, bl * light, on, on, 0, rank);
          put(v++, x[b], y[b], z1, r * light, g * light, bl * light, 0, on, on, rank);
          put(v++, x[a], y[a], z1, r * light, g * light, bl * light, 0, on, 0, rank);
        }
      } else {
        const [r, g, bl] = paint.face(kind, slab, t, -1, -1);
        const z = kind === "up" ? slab_z[slab + 1] : slab_z[slab];
        const p = corners[3 * t], q = corners[3 * t + (kind === "up" ? 1 : 2)], s = corners[3 * t + (kind === "up" ? 2 : 1)];
        put(v++, x[p], y[p], z, r * light_cap, g * light_cap, bl * light_cap, on, 0, 0, rank);
        put(v++, x[q], y[q], z, r * light_cap, g * light_cap, bl * light_cap, 0, on, 0, rank);
        put(v++, x[s], y[s], z, r * light_cap, g * light_cap, bl * light_cap, 0, 0, on, rank);
      }
      next[tile] = v;
    }
  }
  return { position, colour, corner, ranges, num_faces, num_vertices, per_side };
}

/// Outer walls alone, one quadrilateral per slab: they stand for all walls while the view moves.
export function build_rim(prisms, visibility, paint, centre) {
  const { corners, x, y, slab_z, border } = prisms;
  const position = [], colour = [], corner = [];
  const stride = Math.ceil((border.length * prisms.num_slabs) / 60000);
  if (stride > 1) return { position: new Float32Array(0), colour: new Uint8Array(0), corner: new Uint8Array(0) };
  for (const side of border) {
    const t = (side / 3) | 0, a = corners[side], b = corners[side % 3 === 2 ? side - 2 : side + 1];
    const dx = x[b] - x[a], dy = y[b] - y[a], length = Math.hypot(dx, dy) || 1, light = light_on(dy / length, -dx / length, 0);
    for (let s = 0; s < prisms.num_slabs; ++s) {
      if (visibility.at(s, t) < 0) continue;
      const c = paint.face("wall", s, t, a, b).map((v) => v * light);
      const low = slab_z[s], high = slab_z[s + 1];
      for (const [v, z] of [[a, low], [b, low], [b, high], [a, low], [b, high], [a, high]]) {
        position.push(x[v] - centre[0], y[v] - centre[1], z - centre[2]);
        colour.push(c[0], c[1], c[2], 255);
        corner.push(255, 255, 255, Math.min(255, visibility.rank[s]));
      }
    }
  }
  return { position: new Float32Array(position), colour: new Uint8Array(colour), corner: new Uint8Array(corner) };
}

/// Faces that a plane lays open. plane: { axis: 0 | 1 | 2, at (mm), keep_above }.
export function build_section(prisms, visibility, paint, centre, plane) {
  const { corners, x, y, slab_z, num_slabs } = prisms;
  const position = [], colour = [], corner = [];
  const put = (p, c, e, rank) => {
    position.push(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]);
    colour.push(c[0], c[1], c[2], 255);
    corner.push(e[0], e[1], e[2], rank);
  };
  const at = plane.at + 3.7e-8; // never through the corners of a board on the nanometre grid
  const sign = plane.keep_above ? -1 : 1;
  const light = light_on(plane.axis === 0 ? sign : 0, plane.axis === 1 ? sign : 0, plane.axis === 2 ? sign : 0);
  for (let t = 0; t < prisms.num_triangles; ++t) {
    const v = [corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]];
    if (plane.axis === 2) {
      for (let s = 0; s < num_slabs; ++s) {
        if (!(slab_z[s] < at && at < slab_z[s + 1]) || visibility.at(s, t) < 0) continue;
        let k = prisms.first_sublayer[s];
        while (prisms.z[k + 1] < at) ++k;
        const c = paint.face("section", s, t, -1, -1, k).map((v) => v * light), rank = Math.min(255, visibility.rank[s]);
        const order = plane.keep_above ? [1, 0, 2] : [0, 1, 2];
        order.forEach((i, k) => put([x[v[i]], y[v[i]], at], c, [k === 0 ? 255 : 0, k === 1 ? 255 : 0, k === 2 ? 255 : 0], rank));
      }
      continue;
    }
    const along = plane.axis === 0 ? x : y;
    const hits = [];
    for (let i = 0; i < 3; ++i) {
      const p = v[i], q = v[(i + 1) % 3], dp = along[p] - at, dq = along[q] - at;
      if (dp < 0 !== dq < 0) {
        const s = dp / (dp - dq);
        hits.push([x[p] + s * (x[q] - x[p]), y[p] + s * (y[q] - y[p])]);
      }
    }
    if (hits.length !== 2) continue;
    const other = 1 - plane.axis, ascending = (plane.axis === 0) !== plane.keep_above;
    if (hits[0][other] < hits[1][other] !== ascending) hits.reverse();
    for (let s = 0; s < num_slabs; ++s) {
      if (visibility.at(s, t) < 0) continue;
      const rank = Math.min(255, visibility.rank[s]), [p, q] = hits;
      let c = null;
      for (let k = prisms.first_sublayer[s]; k < prisms.first_sublayer[s + 1]; ++k) {
        const z0 = prisms.z[k], z1 = prisms.z[k + 1];
        if (!c || paint.mode === "q_p") c = paint.face("section", s, t, -1, -1, k).map((v) => v * light);
        put([p[0], p[1], z0], c, [255, 255, 0], rank);
        put([q[0], q[1], z0], c, [0, 255, 0], rank);
        put([q[0], q[1], z1], c, [0, 255, 255], rank);
        put([p[0], p[1], z0], c, [255, 255, 0], rank);
        put([q[0], q[1], z1], c, [0, 255, 255], rank);
        put([p[0], p[1], z1], c, [0, 255, 0], rank);
      }
    }
  }
  return { position: new Float32Array(position), colour: new Uint8Array(colour), corner: new Uint8Array(corner) };
}

/// Faces of the wanted face tags, straight from the tables: hull, skins, sheets, ports alike.
export function build_tagged(prisms, visibility, wanted, colours, centre) {
  const { corners, x, y, slab_z, caps, walls, first_sublayer } = prisms;
  const slab_above = new Map();
  first_sublayer.forEach((k, s) => slab_above.set(k, s));
  let count = 0;
  for (let i = 0; i < caps.tag.length; ++i) if (wanted[caps.tag[i]]) count += 3;
  for (let i = 0; i < walls.tag.length; ++i) if (wanted[walls.tag[i]]) count += 6;
  const position = new Float32Array(3 * count), colour = new Uint8Array(4 * count), corner = new Uint8Array(4 * count);
  let v = 0;
  const put = (px, py, pz, c, light, e0, e1, e2, rank) => {
    position.set([px - centre[0], py - centre[1], pz - centre[2]], 3 * v);
    colour.set([c[0] * light, c[1] * light, c[2] * light, 255], 4 * v);
    corner.set([e0, e1, e2, rank], 4 * v);
    ++v;
  };
  for (let i = 0; i < caps.tag.length; ++i) {
    if (!wanted[caps.tag[i]]) continue;
    const t = caps.triangle[i], face = slab_above.get(caps.place[i] >> 1);
    // The cell it belongs to: below where it faces up.
    const slab = Math.max(0, Math.min(prisms.num_slabs - 1, caps.place[i] & 1 ? face - 1 : face));
    const rank = Math.min(255, visibility.rank[slab]), c = colours[caps.tag[i]];
    for (let k = 0; k < 3; ++k) put(x[corners[3 * t + k]], y[corners[3 * t + k]], slab_z[face], c, light_on(0, 0, 1), k === 0 ? 255 : 0, k === 1 ? 255 : 0, k === 2 ? 255 : 0, rank);
  }
  for (let i = 0; i < walls.tag.length; ++i) {
    if (!wanted[walls.tag[i]]) continue;
    const a = walls.a[i], b = walls.b[i], s = walls.slab[i], c = colours[walls.tag[i]], rank = Math.min(255, visibility.rank[s]);
    const dx = x[b] - x[a], dy = y[b] - y[a], length = Math.hypot(dx, dy) || 1, light = light_on(dy / length, -dx / length, 0);
    const low = slab_z[s], high = slab_z[s + 1];
    put(x[a], y[a], low, c, light, 255, 255, 0, rank);
    put(x[b], y[b], low, c, light, 0, 255, 0, rank);
    put(x[b], y[b], high, c, light, 0, 255, 255, rank);
    put(x[a], y[a], low, c, light, 255, 255, 0, rank);
    put(x[b], y[b], high, c, light, 0, 255, 255, rank);
    put(x[a], y[a], high, c, light, 0, 255, 0, rank);
  }
  return { position, colour, corner };
}

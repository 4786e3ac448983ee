// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of faces: the same choices as src/view/paint.cpp, whose palette comes with the tables.

export const is_continuous = (mode) => mode === "q_p" || mode === "q_t" || mode === "size";

export const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
export const blend = (a, b, share) => a.map((v, i) => v + share * (b[i] - v));
export const no_value = [150, 156, 163];
export function colour_at(ramp, x) {
  const p = Math.min(Math.max(x, 0), 1) * (ramp.length - 1), i = Math.min(p | 0, ramp.length - 2);
  return blend(ramp[i], ramp[i + 1], p - i);
}

export class Paint {
  constructor(prisms, mode) {
    const { tables } = prisms;
    Object.assign(this, { prisms, mode });
    this.ramp = tables.ramp.map(rgb);
    this.kinds = tables.groups.map((g) => tables.materials[g.material].kind);
    this.groups = tables.groups.map((g) =>
      rgb(mode === "net" ? g.net_colour : mode === "layer" ? tables.layers[g.layer].colour : mode === "group" ? g.colour : tables.materials[g.material].colour));
    this.tags = tables.face_tags.map((tag) => rgb(tag.colour));
    if (mode === "tag") this.index_tags();
    this.range = mode === "size" ? prisms.size_range : [0, 1];
  }
  index_tags() {
    const { caps, walls, num_triangles, num_points } = this.prisms;
    this.cap_tags = new Map();
    for (let i = 0; i < caps.tag.length; ++i) this.cap_tags.set(caps.place[i] * num_triangles + caps.triangle[i], caps.tag[i]);
    this.wall_tags = new Map();
    for (let i = 0; i < walls.tag.length; ++i)
      this.wall_tags.set((walls.slab[i] * num_points + walls.a[i]) * num_points + walls.b[i], walls.tag[i]);
  }
  value(slab, t, sublayer) {
    return this.mode === "q_p" ? this.prisms.prism_quality(slab, t, this.prisms.z[sublayer + 1] - this.prisms.z[sublayer]) : this.mode === "q_t" ? this.prisms.triangle_quality(t) : this.prisms.longest[t];
  }
  /// kind: "up", "down", "wall" or "section"; a, b: planar edge of a wall, the cell to its left; sublayer: of the cell, which
  /// only q_p asks for. Without it the cell is the one at the face; of walls drawn in one piece, the lowest.
  face(kind, slab, t, a, b, sublayer = this.prisms.first_sublayer[kind === "up" ? slab + 1 : slab] - (kind === "up" ? 1 : 0)) {
    const { prisms, mode } = this;
    if (is_continuous(mode)) {
      const value = this.value(slab, t, sublayer), [low, high] = this.range;
      return colour_at(this.ramp, mode === "size" ? (high > low ? Math.log(value / low) / Math.log(high / low) : 0.5) : (value - low) / (high - low));
    }
    if (mode === "tag") {
      let tag;
      if (kind === "wall") tag = this.wall_tags.get((slab * prisms.num_points + a) * prisms.num_points + b);
      else if (kind !== "section") tag = this.cap_tags.get((2 * prisms.first_sublayer[slab + (kind === "up" ? 1 : 0)] + (kind === "up" ? 1 : 0)) * prisms.num_triangles + t);
      return tag === undefined ? no_value : this.tags[tag];
    }
    const group = prisms.group(slab, t), own = this.groups[group];
    if (this.kinds[group] !== "mask") return own;
    const behind = kind === "up" ? slab - 1 : kind === "down" ? slab + 1 : -1;
    if (behind < 0 || behind >= prisms.num_slabs) return own;
    const other = prisms.group(behind, t);
    return other >= 0 && this.kinds[other] === "conductor" ? blend(own, this.groups[other], mode === "net" ? 0.75 : 0.5) : own;
  }
}

/// Light on a face with unit normal n: light_on of src/view/paint.cpp.
export function light_on(nx, ny, nz) {
  return Math.min(1, Math.max(0.55, 0.74 + 0.3 * (0.34 * nx - 0.52 * ny + 0.78 * nz)));
}

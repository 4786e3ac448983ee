// SPDX-License-Identifier: GPL-3.0-or-later
// Layers as textures. A moving view on a machine without a graphics card can't afford a million triangles; one textured
// rectangle per layer shows nearly the same. One picture of triangle ids serves every layer and every colour.
import { light_on } from "./paint.mjs";

export class Cards {
  constructor(prisms) {
    this.prisms = prisms;
    const { min_x, min_y, max_x, max_y } = prisms.box;
    const longest = prisms.num_slabs > 12 ? 1024 : 1536;
    const scale = longest / Math.max(max_x - min_x, max_y - min_y);
    this.width = Math.max(2, Math.round(scale * (max_x - min_x)));
    this.height = Math.max(2, Math.round(scale * (max_y - min_y)));
    this.ids = new Int32Array(this.width * this.height).fill(-1);
    this.fill_ids((max_x - min_x) / this.width, (max_y - min_y) / this.height);
  }
  fill_ids(dx, dy) {
    const { corners, x, y, num_triangles, box } = this.prisms;
    const { width, height, ids } = this;
    for (let t = 0; t < num_triangles; ++t) {
      const px = [0, 0, 0], py = [0, 0, 0];
      let low = Infinity, high = -Infinity;
      for (let i = 0; i < 3; ++i) {
        px[i] = (x[corners[3 * t + i]] - box.min_x) / dx - 0.5;
        py[i] = (y[corners[3 * t + i]] - box.min_y) / dy - 0.5;
        low = Math.min(low, py[i]);
        high = Math.max(high, py[i]);
      }
      const last = Math.min(height - 1, Math.floor(high));
      for (let row = Math.max(0, Math.ceil(low)); row <= last; ++row) {
        let from = Infinity, to = -Infinity;
        for (let i = 0; i < 3; ++i) {
          const j = (i + 1) % 3;
          if (py[i] <= row !== py[j] <= row) {
            const at = px[i] + ((row - py[i]) / (py[j] - py[i])) * (px[j] - px[i]);
            if (at < from) from = at;
            if (at > to) to = at;
          }
        }
        const end = Math.min(width - 1, Math.floor(to));
        for (let i = Math.max(0, Math.ceil(from)); i <= end; ++i) ids[row * width + i] = t;
      }
    }
  }
  /// Pixels of what shows at the upper ("up") or lower ("down") face of one slab, or null where nothing does.
  draw(kind, slab, visibility, paint) {
    const { prisms, ids } = this;
    const colours = new Uint32Array(prisms.num_triangles);
    const light = kind === "up" ? light_on(0, 0, 1) : light_on(0, 0, -1);
    const beside = kind === "up" ? slab + 1 : slab - 1;
    // One colour per column will do where neither quality nor tags are shown.
    const by_column = ["material", "net", "layer", "group"].includes(paint.mode) ? new Int32Array(prisms.tables.columns.length).fill(-1) : null;
    let any = false;
    for (let t = 0; t < prisms.num_triangles; ++t) {
      const here = visibility.at(slab, t);
      if (here < 0 || here === visibility.at(beside, t)) continue;
      any = true;
      const column = prisms.column[t];
      if (by_column && by_column[column] !== -1) {
        colours[t] = by_column[column];
        continue;
      }
      const [r, g, b] = paint.face(kind, slab, t, -1, -1);
      colours[t] = (255 << 24) | ((b * light) << 16) | ((g * light) << 8) | (r * light);
      if (by_column) by_column[column] = colours[t];
    }
    if (!any) return null;
    const pixels = new Uint32Array(ids.length);
    for (let i = 0; i < ids.length; ++i) if (ids[i] >= 0) pixels[i] = colours[ids[i]];
    return new Uint8Array(pixels.buffer);
  }
}

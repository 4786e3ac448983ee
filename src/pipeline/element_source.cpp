// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/pipeline/element_source.hpp"

#include <utility>

#include "pcbmesh/extrude/tetrahedral_source.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "pcbmesh/mesh/prism_source.hpp"

namespace pcbmesh::pipeline {

ElementSource::ElementSource(const MeshBoardResult& result) {
  const study::Study& study = result.resolved;
  if (study.order == 2) {
    extrude::SecondOrderOptions options;
    options.with_face_nodes = study.wedge_nodes == 18;
    options.for_tetrahedra = study.split == study::ElementSplit::tetrahedra;
    options.longest_sagitta_m = static_cast<double>(study.arcs.sagitta_nm) * metres_per_nm;
    for (const geometry::OutlineCircle& circle : result.circles)
      options.circles.push_back({{circle.x_nm * metres_per_nm, circle.y_nm * metres_per_nm}, circle.radius_nm * metres_per_nm});
    auto source = std::make_unique<extrude::SecondOrderSource>(result.mesh, std::move(options), layering::prism_qualities);
    second_order_ = source->statistics();
    prisms_ = std::move(source);
  } else {
    prisms_ = std::make_unique<mesh::PrismSource>(result.mesh, layering::prism_qualities);
  }
  if (study.split == study::ElementSplit::tetrahedra) tetrahedra_ = std::make_unique<extrude::TetrahedralSource>(*prisms_);
}

}  // namespace pcbmesh::pipeline

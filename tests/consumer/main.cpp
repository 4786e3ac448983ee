// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const pcbmesh::formats::ReadBoardResult read = pcbmesh::formats::read_board(argv[1]);
  const pcbmesh::pipeline::MeshBoardResult result = pcbmesh::pipeline::mesh_board(read.board, {});
  pcbmesh::formats::write_mesh(result.mesh, argv[2], {});
  std::printf("%lld prisms\n", static_cast<long long>(result.mesh.num_prisms()));
  return result.mesh.num_prisms() > 0 ? 0 : 1;
}

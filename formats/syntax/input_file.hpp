// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace pcbmesh::formats::syntax {

/// Most bytes taken from one file after unpacking, 1 GiB: a compressed bomb must not eat the machine.
inline constexpr std::size_t max_unpacked_bytes = std::size_t{1} << 30;

/// The whole file as bytes. Contents that are xz or gzip (told by their first bytes, or claimed by the ending .xz or .gz)
/// are unpacked on the fly; several streams or members in a row are joined.
/// @throws Error file_unreadable (201): absent, a folder, not readable, or above max_unpacked_bytes;
///               file_truncated (205): the packed stream ends early; file_syntax (202): the packed stream is damaged.
/// @cost one pass; peak memory about twice the unpacked size for packed files, once for plain ones.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& file);

/// The first bytes of the file, unpacked as above; fewer if the file is shorter. For sniffing formats.
/// @throws Error as read_whole_file.
[[nodiscard]] std::string read_head(const std::filesystem::path& file, std::size_t num_bytes = 4096);

/// File name without folder and without a last .xz or .gz: "a/b.kicad_pcb.xz" gives "b.kicad_pcb".
[[nodiscard]] std::string unpacked_name(const std::filesystem::path& file);

}  // namespace pcbmesh::formats::syntax

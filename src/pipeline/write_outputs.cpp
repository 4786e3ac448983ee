// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/pipeline/write_outputs.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "formats/sink/file_sink.hpp"
#include "formats/tags_json/tags_json.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/mesh_data_source.hpp"
#include "pcbmesh/mesh/prism_source.hpp"
#include "pcbmesh/pipeline/element_source.hpp"
#include "pcbmesh/validation/certificate.hpp"

namespace pcbmesh::pipeline {
namespace {

/// @param expectation  of tags.json; its unit becomes that of the mesh that was judged.
validation::Report judge(mesh::MeshSource& source, const OutputOptions& options, validation::Expectation& expectation,
                         const Progress& progress) {
  for (const std::filesystem::path& file : options.meshes) {
    if (formats::find_mesh_format(file, options.format)->read == nullptr) continue;
    progress.at("check", 0);
    return validation::check(formats::read_mesh(file, options.format, progress), &expectation, {options.num_threads});
  }
  progress.at("check", 0);
  expectation.unit_m = 1.0;
  return validation::check(mesh::expand(source), &expectation, {options.num_threads});
}

}  // namespace

std::filesystem::path file_beside(const std::filesystem::path& mesh, std::string_view ending) {
  std::filesystem::path file = mesh;
  file.replace_extension();
  file += ending;
  return file;
}

void require_writable(const OutputOptions& options, const std::filesystem::path& input) {
  std::vector<std::filesystem::path> seen;
  for (const std::filesystem::path& file : options.meshes) {
    const Spot spot{.file = file.string()};
    const std::filesystem::path absolute = std::filesystem::absolute(file);
    std::filesystem::path folder = absolute.parent_path();
    while (options.makes_folder && !std::filesystem::exists(folder)) folder = folder.parent_path();
    if (!std::filesystem::is_directory(folder))
      throw Error(ErrorCode::write_failed, "the folder does not exist; make it first", {.file = folder.string()});
    const formats::MeshFormat* format = formats::find_mesh_format(file, options.format);
    if (std::filesystem::is_directory(file) && (format == nullptr || !format->scope.is_folder))
      throw Error(ErrorCode::write_failed, "this is a folder; name a file in it, e.g. board.msh", spot);
    if (format == nullptr || format->write == nullptr)
      throw Error(ErrorCode::usage,
                  "no mesh format that pcbmesh writes has this ending; 'pcbmesh formats' lists them, --to NAME picks one",
                  spot);
    std::error_code ignored;
    if (std::filesystem::equivalent(file, input, ignored))
      throw Error(ErrorCode::usage, "the output would overwrite the board", spot);
    if (std::find(seen.begin(), seen.end(), absolute) != seen.end())
      throw Error(ErrorCode::usage, "this output is named twice", spot);
    seen.push_back(absolute);
  }
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  formats::FileSink sink(file);
  sink.put(text);
  if (!text.ends_with('\n')) sink.put("\n");
  sink.commit();
}

void write_binary_file(const std::filesystem::path& file, std::string_view bytes) {
  formats::FileSink sink(file);
  sink.put(bytes);
  sink.commit();
}

OutputResult write_outputs(const MeshBoardResult& result, const OutputOptions& options, const Progress& progress) {
  OutputResult out;
  if (options.makes_folder) {
    std::error_code fault;
    const std::filesystem::path folder = std::filesystem::absolute(options.meshes.front()).parent_path();
    std::filesystem::create_directories(folder, fault);
    if (fault) throw Error(ErrorCode::write_failed, "the folder can't be made: " + fault.message(), {.file = folder.string()});
  }
  const std::filesystem::path tags = file_beside(options.meshes.front(), ".tags.json"),
                              study = file_beside(options.meshes.front(), ".resolved.json");
  const auto num_volumes = static_cast<std::int32_t>(result.mesh.volume_tags().size());
  ElementSource elements(result);
  out.second_order = elements.second_order();
  // The meshes first: where one can't be written, an older mesh keeps the contract that belongs to it.
  for (const std::filesystem::path& file : options.meshes) {
    formats::write_mesh(elements.source(), file, options.write, options.format, progress);
    out.files.push_back(file.string());
    for (const std::filesystem::path& part : formats::parts_of_mesh(file, options.format)) out.files.push_back(part.string());
  }
  formats::tags_json::write_tags(result.mesh, tags, options.write.unit, options.write.one_number_space ? num_volumes : 0,
                                 &elements.source());
  write_text_file(study, study::to_json(result.resolved));
  out.files.push_back(tags.string());
  out.files.push_back(study.string());
  if (!options.check) return out;
  validation::Expectation expectation = validation::read_expectation(tags.string());
  out.report = judge(elements.source(), options, expectation, progress);
  std::vector<validation::Certificate::File> certified;
  if (!options.board.empty()) certified.push_back(validation::certified_file("board", options.board));
  certified.push_back(validation::certified_file("study", study));
  certified.push_back(validation::certified_file("tags", tags));
  for (const std::filesystem::path& file : options.meshes) {
    certified.push_back(validation::certified_file("mesh", file));
    for (const std::filesystem::path& part : formats::parts_of_mesh(file, options.format)) {
      certified.push_back(validation::certified_file("part", part));
      certified.back().of = file.filename().string();
    }
  }
  const std::filesystem::path certificate = file_beside(options.meshes.front(), ".certificate.json");
  write_text_file(certificate,
                  to_json(validation::certify(*out.report, expectation, expectation.unit_m, std::move(certified))));
  out.files.push_back(certificate.string());
  return out;
}

mesh::MeshData expand(const mesh::PrismMesh& mesh) {
  mesh::PrismSource source(mesh);
  return mesh::expand(source);
}

}  // namespace pcbmesh::pipeline

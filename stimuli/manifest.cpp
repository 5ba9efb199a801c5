#include "stimuli/manifest.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::stimuli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "touchtrial-stimuli";

Json to_json(const StimulusEntry& entry) {
  return {{"label", entry.label},
          {"kind", name_of(entry.kind)},
          {"exemplar", entry.exemplar},
          {"file", entry.file},
          {"seed", entry.seed},
          {"size_px", entry.size_px},
          {"sha256", to_hex(entry.sha256)},
          {"pixels_sha256", to_hex(entry.pixels_sha256)}};
}

Digest read_digest(const Json& entry, const char* key) {
  const auto digest = digest_from_hex(entry.at(key).get<std::string>());
  if (!digest) throw FileError(std::string("\"") + key + "\" is not 64 hexadecimal digits");
  return *digest;
}

StimulusEntry entry_from(const Json& json) {
  StimulusEntry entry;
  entry.label = json.at("label").get<std::string>();
  const auto kind = stimulus_kind_from_name(json.at("kind").get<std::string>());
  if (!kind) throw FileError("\"kind\" is none of texture, object, material, practice, flat");
  entry.kind = *kind;
  entry.exemplar = json.at("exemplar").get<int>();
  entry.file = json.at("file").get<std::string>();
  entry.seed = json.at("seed").get<std::uint64_t>();
  entry.size_px = json.at("size_px").get<int>();
  entry.sha256 = read_digest(json, "sha256");
  entry.pixels_sha256 = read_digest(json, "pixels_sha256");
  return entry;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& pointer,
                         const std::string& reason) {
  throw FileError(one_line(path.string() + (pointer.empty() ? "" : " " + pointer) + ": " + reason +
                           "; generate the stimuli again"));
}

/// Runs `read` and says, if it fails, in which file and where.
template <typename Read>
auto located(const std::filesystem::path& path, const std::string& pointer, const Read& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& error) {
    refuse(path, pointer, error.what());
  } catch (const FileError& error) {
    refuse(path, pointer, error.what());
  }
}

}  // namespace

void write_stimulus_manifest(const std::filesystem::path& path, const StimulusManifest& manifest) {
  Json json = {{"format", kFormat},
               {"generator_version", manifest.generator_version},
               {"licence", manifest.licence},
               {"stimuli", Json::array()}};
  for (const StimulusEntry& entry : manifest.entries) json["stimuli"].push_back(to_json(entry));
  replace_file(path, json.dump(2) + "\n");
}

StimulusManifest read_stimulus_manifest(const std::filesystem::path& path) {
  const Bytes bytes = read_file(path);
  const Json json = located(path, "", [&] { return Json::parse(bytes.begin(), bytes.end()); });
  StimulusManifest manifest;
  const Json stimuli = located(path, "", [&] {
    if (json.at("format") != kFormat) throw FileError("is not a manifest of stimuli");
    manifest.generator_version = json.at("generator_version").get<int>();
    manifest.licence = json.at("licence").get<std::string>();
    return json.at("stimuli");
  });
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    const std::string pointer = "/stimuli/" + std::to_string(i);
    manifest.entries.push_back(located(path, pointer, [&] { return entry_from(stimuli.at(i)); }));
  }
  return manifest;
}

}  // namespace touchtrial::stimuli

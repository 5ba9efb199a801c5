#include "stimuli/default_set.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "engine/image_file.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

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
  if (!kind) throw FileError("\"kind\" is not one of texture, object, material, practice, flat");
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

/// Calls `read` and adds the file and the JSON pointer to its errors.
template <typename Read>
auto with_located_errors(const std::filesystem::path& path, const std::string& pointer,
                         const Read& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& error) {
    refuse(path, pointer, error.what());
  } catch (const FileError& error) {
    refuse(path, pointer, error.what());
  }
}

std::string file_of(std::string_view label, int exemplar) {
  const std::string name(label);
  if (exemplar == 1) return name + ".png";
  return "exemplars/" + name + "-" + std::to_string(exemplar) + ".png";
}

/// The entries of the pictures to generate, without digests.
std::vector<StimulusEntry> entries_to_generate(const StimuliChoice& choice) {
  std::vector<StimulusEntry> entries;
  for (const StimulusRecipe& recipe : stimulus_recipes()) {
    if (choice.kind && recipe.kind != *choice.kind) continue;
    const bool has_one_exemplar = recipe.kind == StimulusKind::flat;
    const int count =
        has_one_exemplar ? 1 : choice.exemplars.value_or(shipped_exemplars(recipe.kind));
    for (int exemplar = 1; exemplar <= count; ++exemplar) {
      StimulusEntry& entry = entries.emplace_back();
      entry.label = recipe.label;
      entry.kind = recipe.kind;
      entry.exemplar = exemplar;
      entry.file = file_of(recipe.label, exemplar);
      entry.seed = choice.seed;
      entry.size_px = choice.size_px;
    }
  }
  return entries;
}

/// \param may_replace  whether to replace a file without the output mark, as in a copy of an
///   earlier set
void write_stimulus(const std::filesystem::path& folder, StimulusEntry& entry, bool may_replace) {
  const GreyImage picture =
      generate_stimulus(entry.label, entry.seed, entry.size_px, entry.exemplar);
  make_folder((folder / entry.file).parent_path());
  if (may_replace && origin_of(folder / entry.file) != Origin::ours) {
    std::filesystem::remove(folder / entry.file);
  }
  engine::write_png(folder / entry.file, picture);
  entry.sha256 = sha256_of_file(folder / entry.file);
  entry.pixels_sha256 = sha256(picture.samples());
}

/// The manifest of an earlier set in the folder; empty if there is none or it is a foreign file.
StimulusManifest read_earlier_manifest(const std::filesystem::path& folder) {
  const auto manifest = folder / kStimulusManifestFile;
  require_output_path(manifest);
  try {
    return path_exists(manifest) ? read_stimulus_manifest(manifest) : StimulusManifest{};
  } catch (const FileError&) {
    return {};
  }
}

/// Whether the file belongs to an earlier set and is unchanged.
bool is_unchanged(const StimulusManifest& earlier_manifest, const std::string& file,
                  const std::filesystem::path& folder) {
  const auto entry = std::ranges::find(earlier_manifest.entries, file, &StimulusEntry::file);
  return entry != earlier_manifest.entries.end() && path_exists(folder / file) &&
         sha256_of_file(folder / file) == entry->sha256;
}

bool contains_file(const StimulusManifest& manifest, const std::string& file) {
  return std::ranges::find(manifest.entries, file, &StimulusEntry::file) != manifest.entries.end();
}

void require_output_paths(const std::filesystem::path& folder,
                          const StimulusManifest& earlier_manifest,
                          const StimulusManifest& manifest) {
  for (const StimulusEntry& entry : manifest.entries) {
    if (!is_unchanged(earlier_manifest, entry.file, folder))
      require_output_path(folder / entry.file);
  }
}

/// Removes the pictures that only the earlier set has, unless they were changed.
void remove_obsolete(const std::filesystem::path& folder, const StimulusManifest& earlier_manifest,
                     const StimulusManifest& new_manifest) {
  for (const StimulusEntry& entry : earlier_manifest.entries) {
    const auto file = folder / entry.file;
    const bool is_generated =
        std::ranges::find(stimulus_recipes(), entry.label, &StimulusRecipe::label) !=
            stimulus_recipes().end() &&
        entry.file == file_of(entry.label, entry.exemplar);
    if (!is_generated || contains_file(new_manifest, entry.file) || !path_exists(file)) continue;
    if (sha256_of_file(file) == entry.sha256) std::filesystem::remove(file);
  }
}

}  // namespace

void write_stimulus_manifest(const std::filesystem::path& path, const StimulusManifest& manifest) {
  Json json = {{"format", kFormat},
               {"generator_version", manifest.generator_version},
               {"licence", manifest.licence},
               {"stimuli", Json::array()}};
  for (const StimulusEntry& entry : manifest.entries) json["stimuli"].push_back(to_json(entry));
  write_output(path, json.dump(2) + "\n");
}

StimulusManifest read_stimulus_manifest(const std::filesystem::path& path) {
  const Bytes bytes = read_file(path);
  const Json json =
      with_located_errors(path, "", [&] { return Json::parse(bytes.begin(), bytes.end()); });
  StimulusManifest manifest;
  const Json stimuli = with_located_errors(path, "", [&] {
    if (json.at("format") != kFormat) throw FileError("is not a manifest of stimuli");
    manifest.generator_version = json.at("generator_version").get<int>();
    manifest.licence = json.at("licence").get<std::string>();
    return json.at("stimuli");
  });
  for (std::size_t i = 0; i < stimuli.size(); ++i) {
    const std::string pointer = "/stimuli/" + std::to_string(i);
    manifest.entries.push_back(
        with_located_errors(path, pointer, [&] { return entry_from(stimuli.at(i)); }));
  }
  return manifest;
}

StimulusManifest generate_default_stimuli(const std::filesystem::path& folder,
                                          const StimuliChoice& choice,
                                          const StimuliProgress& progress) {
  const int exemplars = choice.exemplars.value_or(1);
  if (exemplars < 1 || exemplars > kMaxStimulusExemplars) {
    throw UsageError("a set of " + std::to_string(exemplars) +
                     " exemplars of each label cannot be generated; choose 1 to " +
                     std::to_string(kMaxStimulusExemplars));
  }
  StimulusManifest manifest;
  manifest.entries = entries_to_generate(choice);
  const StimulusManifest earlier_manifest = read_earlier_manifest(folder);
  require_output_paths(folder, earlier_manifest, manifest);
  make_folder(folder);
  int done_count = 0;
  for (StimulusEntry& entry : manifest.entries) {
    write_stimulus(folder, entry, is_unchanged(earlier_manifest, entry.file, folder));
    if (progress) progress(++done_count, static_cast<int>(manifest.entries.size()));
  }
  write_stimulus_manifest(folder / kStimulusManifestFile, manifest);
  remove_obsolete(folder, earlier_manifest, manifest);
  return manifest;
}

}  // namespace touchtrial::stimuli

#include "stimuli/default_set.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/image_file.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::stimuli {
namespace {

std::string file_of(std::string_view label, int exemplar) {
  const std::string name(label);
  if (exemplar == 1) return name + ".png";
  return "exemplars/" + name + "-" + std::to_string(exemplar) + ".png";
}

/// The pictures to make, without their digests.
std::vector<StimulusEntry> chosen_entries(const StimuliChoice& choice) {
  std::vector<StimulusEntry> entries;
  for (const StimulusRecipe& recipe : stimulus_recipes()) {
    const bool one_is_enough = recipe.kind == StimulusKind::flat;
    const int wanted =
        one_is_enough ? 1 : choice.exemplars.value_or(shipped_exemplars(recipe.kind));
    for (int exemplar = 1; exemplar <= wanted; ++exemplar) {
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

void write_stimulus(const std::filesystem::path& folder, StimulusEntry& entry) {
  const GreyImage picture =
      generate_stimulus(entry.label, entry.seed, entry.size_px, entry.exemplar);
  make_folder((folder / entry.file).parent_path());
  engine::write_png(folder / entry.file, picture);
  entry.sha256 = sha256_of_file(folder / entry.file);
  entry.pixels_sha256 = sha256(picture.samples());
}

/// What an earlier set in the folder lists; nothing where there is none.
StimulusManifest earlier_set(const std::filesystem::path& folder) {
  const auto manifest = folder / kStimulusManifestFile;
  return is_there(manifest) ? read_stimulus_manifest(manifest) : StimulusManifest{};
}

bool lists(const StimulusManifest& manifest, const std::string& file) {
  return std::ranges::find(manifest.entries, file, &StimulusEntry::file) != manifest.entries.end();
}

void refuse_foreign_pictures(const std::filesystem::path& folder, const StimulusManifest& earlier,
                             const StimulusManifest& wanted) {
  for (const StimulusEntry& entry : wanted.entries) {
    const auto file = folder / entry.file;
    if (!is_there(file) || lists(earlier, entry.file)) continue;
    throw FileError(one_line(file.string()) +
                    ": is in the way and belongs to no generated set; move it, or choose another "
                    "folder with -o");
  }
}

/// Removes what the earlier set had and the new one has not, if it is as it was made.
void remove_left_over(const std::filesystem::path& folder, const StimulusManifest& earlier,
                      const StimulusManifest& made) {
  for (const StimulusEntry& entry : earlier.entries) {
    const auto file = folder / entry.file;
    const bool ours = std::ranges::find(stimulus_recipes(), entry.label, &StimulusRecipe::label) !=
                          stimulus_recipes().end() &&
                      entry.file == file_of(entry.label, entry.exemplar);
    if (!ours || lists(made, entry.file) || !is_there(file)) continue;
    if (sha256_of_file(file) == entry.sha256) std::filesystem::remove(file);
  }
}

}  // namespace

StimulusManifest generate_default_stimuli(const std::filesystem::path& folder,
                                          const StimuliChoice& choice,
                                          const StimuliProgress& progress) {
  const int exemplars = choice.exemplars.value_or(1);
  if (exemplars < 1 || exemplars > kMaxStimulusExemplars) {
    throw UsageError("a set of " + std::to_string(exemplars) +
                     " exemplars of each label cannot be made; choose 1 to " +
                     std::to_string(kMaxStimulusExemplars));
  }
  make_folder(folder);
  StimulusManifest manifest;
  manifest.entries = chosen_entries(choice);
  const StimulusManifest earlier = earlier_set(folder);
  refuse_foreign_pictures(folder, earlier, manifest);
  int done = 0;
  for (StimulusEntry& entry : manifest.entries) {
    write_stimulus(folder, entry);
    if (progress) progress(++done, static_cast<int>(manifest.entries.size()));
  }
  write_stimulus_manifest(folder / kStimulusManifestFile, manifest);
  remove_left_over(folder, earlier, manifest);
  return manifest;
}

}  // namespace touchtrial::stimuli

#include "stimuli/default_set.hpp"

#include "core/files.hpp"
#include "engine/image_file.hpp"

namespace touchtrial {
namespace {

StimulusEntry write_stimulus(const std::filesystem::path& folder, const StimulusRecipe& recipe,
                             std::uint64_t seed, int size_px) {
  StimulusEntry entry;
  entry.label = recipe.label;
  entry.kind = recipe.kind;
  entry.file = entry.label + ".png";
  entry.seed = seed;
  entry.size_px = size_px;
  const GreyImage picture = generate_stimulus(recipe.label, seed, size_px);
  write_png(folder / entry.file, picture);
  entry.sha256 = sha256_of_file(folder / entry.file);
  entry.pixels_sha256 = sha256(picture.samples());
  return entry;
}

}  // namespace

StimulusManifest generate_default_stimuli(const std::filesystem::path& folder, std::uint64_t seed,
                                          int size_px, const StimuliProgress& progress) {
  make_folder(folder);
  StimulusManifest manifest;
  const auto recipes = stimulus_recipes();
  for (const StimulusRecipe& recipe : recipes) {
    manifest.entries.push_back(write_stimulus(folder, recipe, seed, size_px));
    if (progress) {
      progress(static_cast<int>(manifest.entries.size()), static_cast<int>(recipes.size()));
    }
  }
  write_stimulus_manifest(folder / kStimulusManifestFile, manifest);
  return manifest;
}

}  // namespace touchtrial

#include "stimuli/default_set.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <set>
#include <string>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::engine;
using namespace touchtrial::stimuli;

namespace {

constexpr int kTiny = 48;

/// The folder of the shipped set.
std::filesystem::path committed_set() {
  return std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "stimuli";
}

}  // namespace

TEST_CASE("the default set is a file for each recipe and a manifest that matches them") {
  const TempFolder folder;
  const auto set = folder.path() / "new" / "stimuli";
  const StimulusManifest manifest = generate_default_stimuli(set, {5, kTiny, 2});
  REQUIRE(manifest.entries.size() == 2 * stimulus_recipes().size() - 1);
  for (std::size_t i = 0; i < manifest.entries.size(); ++i) {
    const StimulusEntry& entry = manifest.entries[i];
    INFO(entry.file);
    CHECK(entry.label == stimulus_recipes()[i / 2].label);
    CHECK(entry.exemplar == static_cast<int>(i % 2) + 1);
    CHECK(entry.file ==
          (i % 2 == 0 ? entry.label + ".png" : "exemplars/" + entry.label + "-2.png"));
    CHECK(entry.seed == 5);
    CHECK(sha256_of_file(set / entry.file) == entry.sha256);
    const GreyImage picture = read_grey_image(set / entry.file);
    CHECK(sha256(picture.samples()) == entry.pixels_sha256);
    CHECK(picture == generate_stimulus(entry.label, 5, kTiny, entry.exemplar));
  }
  CHECK(read_stimulus_manifest(set / kStimulusManifestFile) == manifest);
}

TEST_CASE("the set that comes with the program matches its manifest and its seed") {
  const StimulusManifest manifest = read_stimulus_manifest(committed_set() / kStimulusManifestFile);
  CHECK(manifest.generator_version == kGeneratorVersion);
  // Every recipe has its first exemplar; there are twenty further ones.
  CHECK(manifest.entries.size() == stimulus_recipes().size() + 20);
  // Making all of them again would take too long.
  const std::set<std::string> made_again = {
      "bark.png", "exemplars/brick-5.png", "shell.png", "endgrain.png", "sand.png", "flat.png"};
  std::size_t made = 0;
  for (const StimulusEntry& entry : manifest.entries) {
    INFO(entry.file);
    CHECK(entry.seed == kDefaultStimuliSeed);
    CHECK(entry.size_px == kDefaultStimulusSizePx);
    CHECK(sha256_of_file(committed_set() / entry.file) == entry.sha256);
    CHECK(sha256(read_grey_image(committed_set() / entry.file).samples()) == entry.pixels_sha256);
    if (made_again.count(entry.file) == 0) continue;
    const GreyImage picture =
        generate_stimulus(entry.label, entry.seed, entry.size_px, entry.exemplar);
    CHECK(sha256(picture.samples()) == entry.pixels_sha256);
    ++made;
  }
  CHECK(made == made_again.size());
}

TEST_CASE("making the set again replaces it by the same bytes and leaves other files alone") {
  const TempFolder folder;
  generate_default_stimuli(folder.path(), {5, kTiny, 1});
  const Bytes before = read_file(folder.path() / "straw.png");
  const Bytes manifest_before = read_file(folder.path() / kStimulusManifestFile);
  replace_file(folder.path() / "own.txt", "own");
  generate_default_stimuli(folder.path(), {5, kTiny, 1});
  CHECK(read_file(folder.path() / "straw.png") == before);
  CHECK(read_file(folder.path() / kStimulusManifestFile) == manifest_before);
  CHECK(text_of(read_file(folder.path() / "own.txt")) == "own");
}

TEST_CASE(
    "a smaller set removes the surplus pictures of the one before, unless they were changed") {
  const TempFolder folder;
  generate_default_stimuli(folder.path(), {5, kTiny, 2});
  replace_file(folder.path() / "exemplars" / "bark-2.png", "own");
  generate_default_stimuli(folder.path(), {5, kTiny, 1});
  CHECK_FALSE(path_exists(folder.path() / "exemplars" / "cloth-2.png"));
  CHECK(text_of(read_file(folder.path() / "exemplars" / "bark-2.png")) == "own");
}

TEST_CASE("somebody's own picture is not replaced, and nothing is made beside it") {
  const TempFolder folder;
  replace_file(folder.path() / "straw.png", "own");
  CHECK_THROWS_WITH(generate_default_stimuli(folder.path(), {5, kTiny, 1}),
                    holds_text("straw.png") && holds_text("--force"));
  CHECK(text_of(read_file(folder.path() / "straw.png")) == "own");
  CHECK_FALSE(path_exists(folder.path() / "bark.png"));
}

TEST_CASE("progress is reported after each picture") {
  const TempFolder folder;
  int last = 0;
  generate_default_stimuli(folder.path(), {5, kMinStimulusSizePx, {}}, [&](int done, int total) {
    CHECK(done == last + 1);
    CHECK(total == 37);
    last = done;
  });
  CHECK(last == 37);
}

TEST_CASE("a folder that cannot be made is refused") {
  const TempFolder folder;
  replace_file(folder.path() / "file", "x");
  CHECK_THROWS_AS(generate_default_stimuli(folder.path() / "file", {5, kTiny, 1}), FileError);
  CHECK_THROWS_AS(generate_default_stimuli(folder.path() / "file" / "set", {5, kTiny, 1}),
                  FileError);
}

TEST_CASE("a set without exemplars or with too many is refused before any picture is made") {
  const TempFolder folder;
  const auto set = folder.path() / "set";
  CHECK_THROWS_AS(generate_default_stimuli(set, {5, kTiny, 0}), UsageError);
  CHECK_THROWS_AS(generate_default_stimuli(set, {5, kTiny, kMaxStimulusExemplars + 1}), UsageError);
  CHECK_FALSE(path_exists(set));
}

TEST_CASE("the manifest names the licence and the generator in plain JSON") {
  const TempFolder folder;
  const auto path = folder.path() / "manifest.json";
  write_stimulus_manifest(path, {});
  const auto json = nlohmann::json::parse(text_of(read_file(path)));
  CHECK(json.at("licence") == "CC0-1.0");
  CHECK(json.at("generator_version") == kGeneratorVersion);
  CHECK(json.at("stimuli").empty());
}

TEST_CASE("a text that is not a manifest is refused with file and place") {
  const TempFolder folder;
  const auto path = folder.path() / "manifest.json";
  const auto refusal = [&](const std::string& content) {
    replace_file(path, content);
    return message_of<FileError>([&] { return read_stimulus_manifest(path); });
  };
  CHECK_THROWS_AS(read_stimulus_manifest(folder.path() / "none.json"), FileError);
  CHECK_THAT(refusal("{"), holds_text("manifest.json"));
  CHECK_THAT(refusal("[]"), holds_text("manifest.json"));
  CHECK_THAT(refusal(R"({"format": "other"})"), names("manifest.json"));
  const std::string start =
      R"({"format": "touchtrial-stimuli", "generator_version": 1, "licence": "CC0-1.0", "stimuli": )";
  CHECK_THAT(refusal(start + "[{}]}"), holds_text("/stimuli/0"));
  CHECK_THAT(refusal(start + "7}"), holds_text("manifest.json"));
  CHECK_THAT(refusal(start + R"([{"label": "a", "kind": "sound"}]})"), holds_text("kind"));
}

#include "protocols/simulation/kept_levels.hpp"

#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using simulation::StimulusLevels;

void check_same(const simulation::PlaneLevels& one, const simulation::PlaneLevels& other) {
  REQUIRE(one.size() == other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(one[i].device == other[i].device);
    CHECK(one[i].curve == other[i].curve);
    CHECK(one[i].db == other[i].db);
    CHECK(one[i].bands_db == other[i].bands_db);
  }
}

void check_same(const StimulusLevels& one, const StimulusLevels& other) {
  CHECK(one.stimuli == other.stimuli);
  REQUIRE(one.levels.size() == other.levels.size());
  for (std::size_t i = 0; i < one.levels.size(); ++i) check_same(one.levels[i], other.levels[i]);
  check_same(one.blank, other.blank);
}

StimulusLevels kept(const TinyStudy& study, const std::string& device,
                    const std::filesystem::path& notes) {
  return simulation::kept_levels_of(study.key(), study.pack(), {device::device_model(device)}, 2,
                                    notes);
}

}  // namespace

TEST_CASE("kept levels are those of the first time, for the same key, pack and device alone") {
  const TempFolder notes;
  const TinyStudy study;
  const StimulusLevels first = kept(study, "touch", notes.path());
  const session::StimulusSource source(study.pack(), study.key().study.rendering);
  check_same(first, simulation::levels_of(study.key(), source, {device::device_model("touch")}, 2));
  // Looked up: the field's files are not needed.
  const auto aside = notes.path() / "aside";
  for (const engine::PackEntry& entry : study.pack().manifest().entries) {
    std::filesystem::create_directory(aside);
    std::filesystem::rename(study.pack().folder() / (entry.code + ".field"), aside / entry.code);
  }
  check_same(kept(study, "touch", notes.path()), first);
  CHECK_THROWS(kept(study, "falcon", notes.path()));
  CHECK_THROWS(kept(study, "touch", {}));
  for (const engine::PackEntry& entry : study.pack().manifest().entries) {
    std::filesystem::rename(aside / entry.code, study.pack().folder() / (entry.code + ".field"));
  }
  check_same(kept(study, "touch", {}), first);
  CHECK(kept(study, "falcon", notes.path()).blank[0].device == "falcon");
  const TinyStudy louder({.first_gain = 2.0});
  CHECK(kept(louder, "falcon", notes.path()).levels[0][0].db !=
        kept(study, "falcon", notes.path()).levels[0][0].db);
}

}  // namespace touchtrial

/// The force models of what trials present.
#include "protocols/session/stimulus_source.hpp"

#include "core/errors.hpp"
#include "protocols/session/tiny_study.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

/// Forces of a light press along a line.
std::vector<Vec3> stroked(const engine::RenderingModel& model) {
  std::vector<Vec3> forces;
  engine::Bristle touch;
  for (double x = 1.0; x < 20.0; x += 0.1) {
    forces.push_back(model.force_n({x, 10.0, -0.3}, {}, touch));
  }
  return forces;
}

TinyStudyOptions practising() {
  return {.trials = R"({"practice": 4, "rove_db": 6})", .practised = 2};
}

}  // namespace

TEST_CASE("practice presents the fields that the pack has for it, at their own gain") {
  const TinyStudy study(practising());
  const study::StudyKey& key = study.key();
  REQUIRE(key.practice.size() == 2);
  const session::StimulusSource source(study.pack(), key);
  const study::Practice practice = study::practice_of(key.study);
  REQUIRE(practice.trials.size() == 4);
  for (const study::Trial& trial : practice.trials) {
    const study::Plane& plane = trial.planes.at(0);
    const std::string& code = key.code_of(plane.field);
    CHECK(std::ranges::count(key.practice, code, &study::KeyedStimulus::code) == 1);
    const engine::MappedField field = study.pack().map(code);
    const engine::RenderingModel expected(
        field.view(), key.study.rendering,
        engine::scaled_db(study.pack().entry(code).gains, key.study.trials.centre_gain_db()));
    CHECK(stroked(source.plane_of(plane, key)) == stroked(expected));
    CHECK_FALSE(stroked(source.plane_of(plane, key)) == stroked(source.blank_plane()));
  }
  study::Plane one{.field = key.practice[0].stimulus};
  study::Plane other{.field = key.practice[1].stimulus};
  CHECK_FALSE(stroked(source.plane_of(one, key)) == stroked(source.plane_of(other, key)));
  one.blank = true;
  CHECK(stroked(source.plane_of(one, key)) == stroked(source.blank_plane()));
}

TEST_CASE("practice changes neither the study's codes nor its planes") {
  const TinyStudy with(practising());
  TinyStudyOptions options = practising();
  options.trials = R"({"practice": 0, "rove_db": 6})";
  const TinyStudy without(options);
  const session::StimulusSource one(with.pack(), with.key());
  const session::StimulusSource other(without.pack(), without.key());
  CHECK(with.pack().manifest().entries.size() == without.pack().manifest().entries.size() + 2);
  for (const study::KeyedStimulus& keyed : without.key().stimuli) {
    CHECK(with.key().code_of(keyed.stimulus) == keyed.code);
    const study::Plane plane{.field = keyed.stimulus, .gain_db = -1.0};
    CHECK(stroked(one.plane_of(plane, with.key())) ==
          stroked(other.plane_of(plane, without.key())));
  }
  CHECK(one.plane().width_px == other.plane().width_px);
}

TEST_CASE("a session does not begin with a pack that lacks a field of practice") {
  const TinyStudy study(practising());
  engine::PackManifest manifest = study.pack().manifest();
  std::erase_if(manifest.entries, [&](const engine::PackEntry& entry) {
    return entry.code == study.key().practice[0].code;
  });
  const std::filesystem::path folder = study.pack().folder();
  engine::write_manifest(folder, manifest);
  CHECK_THROWS_AS(session::StimulusSource(engine::Pack(folder), study.key()), FileError);
}

}  // namespace touchtrial

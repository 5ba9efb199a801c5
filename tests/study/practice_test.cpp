#include "study/practice.hpp"

#include "core/errors.hpp"
#include "engine/pack/pack.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "study/laboratory.hpp"
#include "study/pack_upkeep.hpp"
#include "study/protocol.hpp"
#include "study/signed_pack.hpp"
#include "study/stimulus_field.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

/// The laboratory with two textures to practise on.
struct PracticeLaboratory : Laboratory {
  PracticeLaboratory() {
    document["trials"]["practice"] = 5;
    document["practice"]["classes"] = {{{"label", "one"}, {"images", {"one.png"}}},
                                       {{"label", "two"}, {"images", {"two.png"}}}};
    write_noise(practised(0), 11);
    write_noise(practised(1), 12);
  }
  [[nodiscard]] std::filesystem::path practised(int place) const {
    return folder.path() / (place == 0 ? "one.png" : "two.png");
  }
  [[nodiscard]] study::Study study() const { return parsed(document, folder.path()); }
};

/// Forces of a light press along a line.
std::vector<Vec3> felt(const engine::RenderingModel& model) {
  std::vector<Vec3> forces;
  engine::Bristle touch;
  for (double x = 0.5; x < 4.0; x += 0.1) {
    forces.push_back(model.force_n({x, 2.0, -0.5}, {}, touch));
  }
  return forces;
}

bool has_texture(const engine::RenderingModel& model) {
  const std::vector<Vec3> forces = felt(model);
  return std::ranges::any_of(forces, [&](const Vec3& force) { return force.x != 0.0; });
}

/// Makes the model of a field of the laboratory's pack.
/// \param mapped  keeps the field
engine::RenderingModel model_of(const Laboratory& laboratory, const study::KeyedStimulus& keyed,
                                std::vector<engine::MappedField>& mapped) {
  const engine::Pack pack(laboratory.pack());
  mapped.push_back(pack.map(keyed.code));
  return {mapped.back().view(), laboratory.key().study.rendering, pack.entry(keyed.code).gains};
}

/// A picture whose middle has these samples.
GreyImage framed(const GreyImage& middle, int edge) {
  GreyImage picture(middle.height() + 2 * edge, middle.width() + 2 * edge, 200);
  for (int y = 0; y < middle.height(); ++y) {
    for (int x = 0; x < middle.width(); ++x) picture.at(y + edge, x + edge) = middle.at(y, x);
  }
  return picture;
}

/// The gains of the laboratory's first practice field beside a study with these.
engine::Gains gains_beside(const PracticeLaboratory& laboratory, const engine::Gains& of_study) {
  const study::StudyKey key = laboratory.key();
  const engine::Pack pack(laboratory.pack());
  const std::array<engine::MappedField, 2> fields = {pack.map(key.practice[0].code),
                                                     pack.map(key.practice[1].code)};
  const std::array<engine::FieldView, 2> views = {fields[0].view(), fields[1].view()};
  const std::array<engine::Gains, 1> gains = {of_study};
  return study::practice_gains(views, gains, key.study.rendering).front();
}

constexpr engine::Gains kStrong{.tangential_n = 1.0, .normal_n = 1.0};
constexpr engine::Gains kWeak{.tangential_n = 1e-6, .normal_n = 1e-6};

}  // namespace

TEST_CASE("practice textures are felt on a plane of the study's size, and differ") {
  const PracticeLaboratory laboratory;
  const study::PrepareReport report = laboratory.prepare();
  const study::StudyKey key = laboratory.key();
  REQUIRE(key.practice.size() == 2);
  CHECK(report.stimuli.size() == 3);
  REQUIRE(report.practice.size() == 2);
  CHECK(report.practice[0].class_label == "one");
  std::vector<engine::MappedField> mapped;
  const engine::RenderingModel one = model_of(laboratory, key.practice[0], mapped);
  const engine::RenderingModel two = model_of(laboratory, key.practice[1], mapped);
  CHECK(mapped.front().view().geometry.width_px == kSide);
  CHECK(has_texture(one));
  CHECK_FALSE(felt(one) == felt(two));
  const engine::RenderingModel flat(mapped.front().view(), key.study.rendering, engine::Gains{});
  CHECK_FALSE(has_texture(flat));
  CHECK(felt(flat).front().z > 0.0);
  CHECK_THROWS_AS(key.code_of({5, 0, 0}), StudyError);
}

TEST_CASE("practice is no stronger than the pack, and than the budget allows") {
  const PracticeLaboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const engine::Gains budget = gains_beside(laboratory, kStrong);
  CHECK(budget == gains_beside(laboratory, {.tangential_n = 2.0, .normal_n = 2.0}));
  CHECK(gains_beside(laboratory, kWeak).tangential_n == kWeak.tangential_n);
  CHECK(kWeak.tangential_n < budget.tangential_n / 10.0);

  const study::StudyKey key = laboratory.key();
  const engine::Pack pack(laboratory.pack());
  std::vector<engine::Gains> of_study;
  for (const study::KeyedStimulus& keyed : key.stimuli) {
    of_study.push_back(pack.entry(keyed.code).gains);
  }
  CHECK(pack.entry(key.practice[0].code).gains ==
        gains_beside(laboratory, study::weakest_of(of_study)));
}

TEST_CASE("gains of practice leave the study's own as they are, and explicit ones apply to both") {
  PracticeLaboratory laboratory;
  const study::PrepareReport with = laboratory.prepare();
  laboratory.document["trials"]["practice"] = 0;
  const study::PrepareReport without = laboratory.prepare();
  CHECK(without.practice.empty());
  for (std::size_t i = 0; i < 3; ++i) CHECK(with.stimuli[i].gains == without.stimuli[i].gains);

  laboratory.document["trials"]["practice"] = 5;
  laboratory.document["rendering"] = {{"gains", {{"tangential_n", 0.01}, {"normal_n", 0.001}}}};
  const study::PrepareReport stated = laboratory.prepare();
  CHECK(stated.practice[1].gains == stated.stimuli[0].gains);
}

TEST_CASE("the middle of a larger image is practised on, a smaller one is refused") {
  const PracticeLaboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const study::StudyKey key = laboratory.key();
  const auto checksum = [&] {
    return engine::Pack(laboratory.pack()).entry(key.practice[1].code).checksum;
  };
  const Digest whole = checksum();
  const GreyImage picture = engine::read_grey_image(laboratory.practised(1));
  engine::write_png(laboratory.practised(1), framed(picture, 3));
  CHECK(laboratory.prepare().practice[1].reused);  // its middle is the same
  CHECK(checksum() == whole);
  const PlaneGeometry plane = study::plane_of(key.study);
  CHECK(plane.width_px == kSide);
  CHECK(study::middle_of(framed(picture, 3), plane) == picture);
  CHECK(study::is_made_from(engine::Pack(laboratory.pack()).entry(key.practice[1].code), key,
                            picture, key.practice[1].stimulus));
  CHECK_THROWS_AS(study::middle_of(GreyImage(kSide, kSide - 1, 0), plane), std::invalid_argument);
  engine::write_png(laboratory.practised(0), GreyImage(kSide - 1, kSide, 7));
  CHECK(refuses<StudyError>(
      [&] { return laboratory.prepare(); },
      "/practice/classes/0/images/0: " + laboratory.practised(0).string() + " "));
}

TEST_CASE("a practice image that is missing is named by its place") {
  const PracticeLaboratory laboratory;
  std::filesystem::remove(laboratory.practised(1));
  CHECK(
      refuses<StudyError>([&] { return laboratory.prepare(); }, "/practice/classes/1/images/0: "));
  CHECK(refuses<StudyError>(
      [&] {
        study::check_images_exist(laboratory.study());
        return 0;
      },
      "/practice/classes/1/images/0: "));
}

TEST_CASE("a study without practice has no field of it") {
  PracticeLaboratory laboratory;
  laboratory.document["trials"]["practice"] = 0;
  const study::StudyKey key = laboratory.key();
  CHECK(key.practice.empty());
  CHECK(study::presented_fields(key.study).size() == 3);
  static_cast<void>(laboratory.prepare());
  CHECK(engine::Pack(laboratory.pack()).manifest().entries.size() == 3);
  CHECK(study::practice_of(key.study, drawn(key.study, 1), 1).trials.empty());
}

TEST_CASE("fields of practice follow the study's, whose codes and seal do not depend on them") {
  PracticeLaboratory laboratory;
  const study::StudyKey key = laboratory.key();
  const std::vector<study::StimulusIndex> fields = study::presented_fields(key.study);
  CHECK(fields ==
        std::vector<study::StimulusIndex>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  std::set<std::string> codes;
  for (const study::KeyedStimulus& keyed : key.fields()) {
    CHECK(engine::is_pack_code(keyed.code));
    CHECK(key.code_of(keyed.stimulus) == keyed.code);
    codes.insert(keyed.code);
  }
  CHECK(codes.size() == 5);
  for (const study::KeyedStimulus& keyed : key.practice) {
    CHECK_FALSE(key.stimulus_of(keyed.code));  // no schedule can name it
    CHECK(key.configuration.find(keyed.code) == std::string::npos);
  }

  // A practice texture that becomes a class: nothing says that it was one.
  PracticeLaboratory later;
  later.document["classes"].push_back(later.document["practice"]["classes"][0]);
  later.document["practice"]["classes"][0] = {{"label", "three"}, {"images", {"three.png"}}};
  const study::StudyKey other = later.key();
  CHECK(other.code_of({3, 0, 0}) != key.code_of({3, 0, 0}));
  CHECK(other.code_of({5, 0, 0}) == key.code_of({4, 0, 0}));
  CHECK(other.code_of({0, 0, 0}) == key.code_of({0, 0, 0}));
}

TEST_CASE("a practice texture is built anew when its picture has changed, and only then") {
  const PracticeLaboratory laboratory;
  static_cast<void>(laboratory.prepare());
  const auto whole = laboratory.files();
  CHECK(std::ranges::count_if(
            whole, [](const auto& file) { return file.first.ends_with(".field"); }) == 5);
  const study::PrepareReport again = laboratory.prepare();
  CHECK(again.practice[0].reused);
  CHECK(laboratory.files() == whole);
  write_noise(laboratory.practised(0), 21);
  const study::PrepareReport changed = laboratory.prepare();
  CHECK(reused(changed) == 3);
  CHECK_FALSE(changed.practice[0].reused);
  CHECK(changed.practice[1].reused);
  const std::filesystem::path damaged =
      study::field_path(laboratory.pack(), laboratory.key().practice[1].code);
  replace_file(damaged, std::string("nothing"));
  const engine::Pack pack(laboratory.pack());
  CHECK(refuses<FileError>(
      [&] {
        study::require_complete_pack(pack, laboratory.key());
        return 0;
      },
      laboratory.key().practice[1].code));
}

TEST_CASE("the control of a practice texture is drawn by its label") {
  PracticeLaboratory laboratory;
  laboratory.document["methods"][0]["control"] = "phase-scrambled";
  const study::Study study = laboratory.study();
  CHECK(study::method_of(study, {3, 0, 0}).control_seed ==
        RandomStream(study.seed, "control of practice one").bits());
  CHECK(study::method_of(study, {4, 0, 0}).control_seed !=
        study::method_of(study, {3, 0, 0}).control_seed);
}

TEST_CASE("a station file has the codes of practice, and one from before is refused") {
  PracticeLaboratory laboratory;
  const study::StudyKey key = laboratory.key();
  const auto path = laboratory.folder.path() / "small.station";
  study::save_station_key(path, study::station_key(key, key.stations.front().name));
  const study::StationKey loaded = study::load_station_key(path);
  REQUIRE(loaded.fields().size() == 5);
  for (const study::KeyedStimulus& keyed : key.fields()) {
    CHECK(loaded.code_of(keyed.stimulus) == keyed.code);
  }
  replace_file(path, std::string(R"({"format": "touchtrial-station", "version": 3})"),
               FileMode::owner_only);
  CHECK(
      refuses<FileError>([&] { return study::load_station_key(path); }, "3 4 touchtrial prepare"));
  study::save_study_key(laboratory.folder.path() / "small.key", key);
  const study::StudyKey again = study::load_study_key(laboratory.folder.path() / "small.key");
  REQUIRE(again.practice.size() == 2);
  CHECK(again.practice[1].code == key.practice[1].code);
}

TEST_CASE("practice presents stimuli at their own gain") {
  PracticeLaboratory laboratory;
  laboratory.document["trials"]["rove_db"] = 6;
  const study::Study study = laboratory.study();
  for (const study::Trial& trial : study::practice_of(study, drawn(study, 1), 1).trials) {
    CHECK(trial.planes.at(0).gain_db == -3.0);
  }
}

TEST_CASE("a practice round has every texture about equally often, in an order of its own") {
  const PracticeLaboratory laboratory;
  const study::Study study = laboratory.study();
  std::set<std::vector<int>> orders;
  std::set<std::vector<std::string>> layouts;
  for (int enrolment = 1; enrolment <= 20; ++enrolment) {
    for (int round = 1; round <= 2; ++round) {
      const study::Practice practice = study::practice_of(study, drawn(study, enrolment), round);
      CHECK(practice.trials == study::practice_of(study, drawn(study, enrolment), round).trials);
      REQUIRE(practice.trials.size() == 5);
      std::vector<int> order;
      for (const study::Trial& trial : practice.trials) {
        CHECK(trial.place.trial == static_cast<int>(order.size()) + 1);
        CHECK(trial.role == study::Role::practice);
        const int shown = trial.field().class_index - static_cast<int>(study.classes.size());
        order.push_back(shown);
        const auto position = static_cast<std::size_t>(trial.right.value());
        CHECK(practice.labels.at(position) ==
              study.practice.classes.at(static_cast<std::size_t>(shown)).label);
      }
      const auto ones = std::ranges::count(order, 1);
      CHECK((ones == 2 || ones == 3));
      orders.insert(order);
      std::vector<std::string> layout = practice.labels;
      layouts.insert(layout);
      std::ranges::sort(layout);
      CHECK(layout == std::vector<std::string>{"one", "two"});
    }
  }
  CHECK(orders.size() > 10);
  CHECK(layouts.size() == 2);
}

TEST_CASE("the weakest gains are each gain's lowest") {
  CHECK(study::weakest_of({}) == engine::Gains{});
  const std::array<engine::Gains, 2> gains = {
      engine::Gains{.tangential_n = 1.0, .normal_n = 4.0, .height_mm = 2.0},
      engine::Gains{.tangential_n = 2.0, .normal_n = 3.0, .height_mm = 2.0}};
  CHECK(study::weakest_of(gains) ==
        engine::Gains{.tangential_n = 1.0, .normal_n = 3.0, .height_mm = 2.0});
}

}  // namespace touchtrial

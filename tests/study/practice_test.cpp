#include "study/practice.hpp"

#include "core/errors.hpp"
#include "study/laboratory.hpp"
#include "study/protocol.hpp"
#include "study/refusal.hpp"

#include <set>

namespace touchtrial {
namespace {

/// The laboratory with two textures to practise on.
struct PracticeLaboratory : Laboratory {
  PracticeLaboratory() {
    document["trials"]["practice"] = 5;
    document["practice"]["classes"] = {{{"label", "one"}, {"images", {"one.png"}}},
                                       {{"label", "two"}, {"images", {"two.png"}}}};
    write_noise(folder.path() / "one.png", 11);
    write_noise(folder.path() / "two.png", 12);
  }
  [[nodiscard]] study::Study study() const { return parsed(document, folder.path()); }
};

PlaneGeometry plane_of(int side) {
  return {.pitch_mm = 0.2, .height_px = side, .width_px = side};
}

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

constexpr engine::Gains kStrong{.tangential_n = 1.0, .normal_n = 1.0};
constexpr engine::Gains kWeak{.tangential_n = 1e-6, .normal_n = 1e-6};

}  // namespace

TEST_CASE("practice textures are felt on a plane of the study's size, and differ") {
  const PracticeLaboratory laboratory;
  const study::PracticeSet practice(laboratory.study(), kStrong, plane_of(kSide));
  REQUIRE(practice.classes() == 2);
  CHECK(practice.plane().width_px == kSide);
  CHECK(has_texture(practice.model(0)));
  CHECK_FALSE(felt(practice.model(0)) == felt(practice.model(1)));
  CHECK_FALSE(has_texture(practice.flat()));
  CHECK(felt(practice.flat()).front().z > 0.0);
  CHECK_THROWS_AS(practice.model(2), std::out_of_range);
}

TEST_CASE("practice is no stronger than the pack, and than the budget allows") {
  const PracticeLaboratory laboratory;
  const auto strongest = [&](const engine::Gains& gains) {
    const study::PracticeSet practice(laboratory.study(), gains, plane_of(kSide));
    double most = 0.0;
    for (const Vec3& force : felt(practice.model(0))) most = std::max(most, std::abs(force.x));
    return most;
  };
  CHECK(strongest(kStrong) == strongest({.tangential_n = 2.0, .normal_n = 2.0}));
  CHECK(strongest(kWeak) < strongest(kStrong) / 10.0);
  CHECK(strongest(kWeak) > 0.0);
}

TEST_CASE("the middle of a larger image is practised on, a smaller one is refused") {
  const PracticeLaboratory laboratory;
  CHECK(has_texture(study::PracticeSet(laboratory.study(), kStrong, plane_of(kSide - 4)).model(1)));
  const auto too_large = [&] {
    return study::PracticeSet(laboratory.study(), kStrong, plane_of(kSide + 1));
  };
  CHECK(refuses<StudyError>(too_large, "/practice/classes/0/images/0: has fewer pixels"));
}

TEST_CASE("a practice image that is missing is named by its place") {
  const PracticeLaboratory laboratory;
  std::filesystem::remove(laboratory.folder.path() / "two.png");
  CHECK(refuses<StudyError>(
      [&] { return study::PracticeSet(laboratory.study(), kStrong, plane_of(kSide)); },
      "/practice/classes/1/images/0: "));
  CHECK(refuses<StudyError>(
      [&] {
        study::check_images_exist(laboratory.study());
        return 0;
      },
      "/practice/classes/1/images/0: "));
}

TEST_CASE("a study without practice has the plane without texture") {
  const Laboratory laboratory;
  const study::Study study = parsed(laboratory.document, laboratory.folder.path());
  const study::PracticeSet practice(study, kStrong, plane_of(kSide));
  CHECK(practice.classes() == 0);
  CHECK_FALSE(has_texture(practice.flat()));
  CHECK(study::practice_of(study, drawn(study, 1), 1).trials.empty());
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

TEST_CASE("the weakest gains of a pack are each gain's lowest") {
  engine::PackManifest manifest;
  CHECK(study::weakest_gains(manifest) == engine::Gains{});
  manifest.entries.resize(2);
  manifest.entries[0].gains = {.tangential_n = 1.0, .normal_n = 4.0, .height_mm = 2.0};
  manifest.entries[1].gains = {.tangential_n = 2.0, .normal_n = 3.0, .height_mm = 2.0};
  CHECK(study::weakest_gains(manifest) ==
        engine::Gains{.tangential_n = 1.0, .normal_n = 3.0, .height_mm = 2.0});
}

}  // namespace touchtrial

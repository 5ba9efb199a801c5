#include "study/practice.hpp"

#include "core/random.hpp"
#include "engine/rendering/gains.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace touchtrial::study {
namespace {

engine::Gains weaker(const engine::Gains& one, const engine::Gains& other) {
  return {.tangential_n = std::min(one.tangential_n, other.tangential_n),
          .normal_n = std::min(one.normal_n, other.normal_n),
          .height_mm = std::min(one.height_mm, other.height_mm)};
}

RandomStream stream_of(const ScheduleDraw& draw, const std::string& what, int round) {
  return {draw.secret, "practice: " + what, static_cast<std::uint64_t>(round)};
}

std::vector<int> shuffled_classes(const Study& study, RandomStream& random) {
  std::vector<int> classes(study.practice.classes.size());
  std::iota(classes.begin(), classes.end(), 0);
  shuffle(std::span<int>(classes), random);
  return classes;
}

}  // namespace

GreyImage middle_of(const GreyImage& picture, const PlaneGeometry& plane) {
  const int top = (picture.height() - plane.height_px) / 2;
  const int left = (picture.width() - plane.width_px) / 2;
  if (picture.height() < plane.height_px || picture.width() < plane.width_px) {
    throw std::invalid_argument("middle_of: the picture is smaller than the plane");
  }
  GreyImage middle(plane.height_px, plane.width_px);
  for (int y = 0; y < middle.height(); ++y) {
    for (int x = 0; x < middle.width(); ++x) middle.at(y, x) = picture.at(top + y, left + x);
  }
  return middle;
}

std::vector<engine::Gains> practice_gains(std::span<const engine::FieldView> fields,
                                          std::span<const engine::Gains> of_study,
                                          const engine::RenderingOptions& rendering) {
  if (fields.empty()) return {};
  std::vector<engine::Gains> gains = engine::choose_gains(fields, rendering).of_field;
  if (rendering.gains || rendering.equalise == engine::Equalise::rms) return gains;
  const engine::Gains weakest = weakest_of(of_study);
  for (engine::Gains& of_field : gains) of_field = weaker(of_field, weakest);
  return gains;
}

engine::Gains weakest_of(std::span<const engine::Gains> gains) {
  if (gains.empty()) return {};
  engine::Gains weakest = gains.front();
  for (const engine::Gains& of_field : gains) weakest = weaker(weakest, of_field);
  return weakest;
}

Practice Task::practice(const Study& study, const ScheduleDraw& draw, int round) const {
  const PracticePlan& plan = study.practice;
  Practice practice{.labels = {}, .trials = {}, .criterion = plan.criterion, .rounds = plan.rounds};
  if (plan.classes.empty()) return practice;
  RandomStream layout_random = stream_of(draw, "layout", round);
  const std::vector<int> layout = shuffled_classes(study, layout_random);
  for (const int shown : layout) {
    practice.labels.push_back(plan.classes[static_cast<std::size_t>(shown)].label);
  }
  RandomStream random = stream_of(draw, "order", round);
  const std::vector<int> classes = shuffled_classes(study, random);
  std::vector<int> order;
  for (std::size_t i = 0; i < static_cast<std::size_t>(study.trials.practice); ++i) {
    order.push_back(classes[i % classes.size()]);
  }
  shuffle(std::span<int>(order), random);
  for (const int shown : order) {
    Trial& trial = practice.trials.emplace_back();
    trial.place.trial = static_cast<int>(practice.trials.size());
    trial.role = Role::practice;
    // At the stimuli's own gain: practice is not roved.
    trial.planes.push_back({.field = {static_cast<int>(study.classes.size()) + shown, 0, 0},
                            .gain_db = study.trials.own_gain_db()});
    trial.right = static_cast<int>(std::ranges::find(layout, shown) - layout.begin());
  }
  return practice;
}

}  // namespace touchtrial::study

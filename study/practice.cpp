#include "study/practice.hpp"

#include "core/random.hpp"
#include "engine/rendering/gains.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace touchtrial::study {
namespace {

engine::Gains weaker(const engine::Gains& a, const engine::Gains& b) {
  return {.tangential_n = std::min(a.tangential_n, b.tangential_n),
          .normal_n = std::min(a.normal_n, b.normal_n),
          .height_mm = std::min(a.height_mm, b.height_mm)};
}

RandomStream stream_of(const ScheduleDraw& draw, const std::string& purpose, int round) {
  return {draw.secret, "practice: " + purpose, static_cast<std::uint64_t>(round)};
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
                                          std::span<const engine::Gains> study_gains,
                                          const engine::RenderingOptions& rendering) {
  if (fields.empty()) return {};
  std::vector<engine::Gains> gains = engine::choose_gains(fields, rendering).per_field;
  if (rendering.gains || rendering.equalise == engine::Equalise::rms) return gains;
  const engine::Gains weakest = weakest_of(study_gains);
  for (engine::Gains& field_gains : gains) field_gains = weaker(field_gains, weakest);
  return gains;
}

engine::Gains weakest_of(std::span<const engine::Gains> gains) {
  if (gains.empty()) return {};
  engine::Gains weakest = gains.front();
  for (const engine::Gains& field_gains : gains) weakest = weaker(weakest, field_gains);
  return weakest;
}

Practice Task::practice(const Study& study, const ScheduleDraw& draw, int round) const {
  const PracticePlan& plan = study.practice;
  Practice practice{.labels = {}, .trials = {}, .criterion = plan.criterion, .rounds = plan.rounds};
  if (plan.classes.empty()) return practice;
  RandomStream layout_random = stream_of(draw, "layout", round);
  const std::vector<int> layout = shuffled_classes(study, layout_random);
  for (const int class_index : layout) {
    practice.labels.push_back(plan.classes[static_cast<std::size_t>(class_index)].label);
  }
  RandomStream random = stream_of(draw, "order", round);
  const std::vector<int> classes = shuffled_classes(study, random);
  std::vector<int> order;
  for (std::size_t i = 0; i < static_cast<std::size_t>(study.trials.practice); ++i) {
    order.push_back(classes[i % classes.size()]);
  }
  shuffle(std::span<int>(order), random);
  for (const int class_index : order) {
    Trial& trial = practice.trials.emplace_back();
    trial.place.trial = static_cast<int>(practice.trials.size());
    trial.role = Role::practice;
    // The gain is at the centre of the roved range, because practice is not roved.
    trial.planes.push_back({.field = {static_cast<int>(study.classes.size()) + class_index, 0, 0},
                            .gain_db = study.trials.centre_gain_db()});
    trial.right = static_cast<int>(std::ranges::find(layout, class_index) - layout.begin());
  }
  return practice;
}

}  // namespace touchtrial::study

#include "study/practice.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "engine/rendering/gains.hpp"
#include "study/protocol.hpp"
#include "study/stimulus_field.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>

namespace touchtrial::study {
namespace {

GreyImage middle_of(const GreyImage& image, const PlaneGeometry& plane) {
  const int top = (image.height() - plane.height_px) / 2;
  const int left = (image.width() - plane.width_px) / 2;
  GreyImage middle(plane.height_px, plane.width_px);
  for (int y = 0; y < middle.height(); ++y) {
    for (int x = 0; x < middle.width(); ++x) middle.at(y, x) = image.at(top + y, left + x);
  }
  return middle;
}

[[noreturn]] void refuse_image(const Study& study, std::size_t index, const std::string& what) {
  throw StudyError(one_line(study.source + ": /practice/classes/" + std::to_string(index) +
                            "/images/0: " + what));
}

GreyImage practice_image(const Study& study, std::size_t index, const PlaneGeometry& plane) {
  const auto path = study.folder / study.practice.classes[index].images.front();
  try {
    const GreyImage image = engine::read_grey_image(path);
    if (image.height() >= plane.height_px && image.width() >= plane.width_px) {
      return middle_of(image, plane);
    }
  } catch (const FileError& error) {
    refuse_image(study, index, error.what());
  }
  refuse_image(study, index,
               "has fewer pixels than the study's plane, " + std::to_string(plane.width_px) +
                   " x " + std::to_string(plane.height_px) + "; take a larger image");
}

engine::TextureField practice_field(const Study& study, std::size_t index,
                                    const PlaneGeometry& plane) {
  engine::ExtractionOptions method = study.methods.front();
  if (method.control != engine::Control::none) {
    const std::string purpose = "control of practice " + study.practice.classes[index].label;
    method.control_seed = RandomStream(study.seed, purpose).bits();
  }
  std::optional<TakenTexture> taken;
  return build_field(practice_image(study, index, plane), method, study.rendering, taken, false)
      .field;
}

std::vector<engine::TextureField> practice_fields(const Study& study, const PlaneGeometry& plane) {
  std::vector<engine::TextureField> fields;
  for (std::size_t i = 0; i < study.practice.classes.size(); ++i) {
    fields.push_back(practice_field(study, i, plane));
  }
  return fields;
}

engine::Gains weaker(const engine::Gains& one, const engine::Gains& other) {
  return {.tangential_n = std::min(one.tangential_n, other.tangential_n),
          .normal_n = std::min(one.normal_n, other.normal_n),
          .height_mm = std::min(one.height_mm, other.height_mm)};
}

/// The gains of each field.
std::vector<engine::Gains> practice_gains(const std::vector<engine::TextureField>& fields,
                                          const engine::Gains& of_pack,
                                          const engine::RenderingOptions& rendering) {
  if (fields.empty()) return {};
  std::vector<engine::FieldView> views;
  for (const engine::TextureField& field : fields) views.push_back(field.view());
  std::vector<engine::Gains> gains = engine::choose_gains(views, rendering).of_field;
  if (rendering.gains || rendering.equalise == engine::Equalise::rms) return gains;
  for (engine::Gains& of_field : gains) of_field = weaker(of_field, of_pack);
  return gains;
}

/// At the stimuli's own gain: practice is not roved.
std::vector<engine::RenderingModel> practice_models(const std::vector<engine::TextureField>& fields,
                                                    const engine::Gains& of_pack,
                                                    const Study& study) {
  const std::vector<engine::Gains> gains = practice_gains(fields, of_pack, study.rendering);
  std::vector<engine::RenderingModel> models;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    models.emplace_back(fields[i].view(), study.rendering,
                        engine::scaled_db(gains[i], study.trials.own_gain_db()));
  }
  return models;
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

PracticeSet::PracticeSet(const Study& study, const engine::Gains& gains, const PlaneGeometry& plane)
    : plane_(plane),
      fields_(practice_fields(study, plane)),
      models_(practice_models(fields_, gains, study)),
      flat_(engine::FieldView{.geometry = plane}, study.rendering, engine::Gains{}) {}

const engine::RenderingModel& PracticeSet::model(int class_index) const {
  return models_.at(static_cast<std::size_t>(class_index));
}

engine::Gains weakest_gains(const engine::PackManifest& manifest) {
  if (manifest.entries.empty()) return {};
  engine::Gains weakest = manifest.entries.front().gains;
  for (const engine::PackEntry& entry : manifest.entries) weakest = weaker(weakest, entry.gains);
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
    trial.planes.push_back({.field = {static_cast<int>(study.classes.size()) + shown, 0, 0}});
    trial.right = static_cast<int>(std::ranges::find(layout, shown) - layout.begin());
  }
  return practice;
}

}  // namespace touchtrial::study

/// \file What simulated participants learn before the first trial: how each class feels.
#pragma once

#include "core/random.hpp"
#include "engine/perception/felt_classifier.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/study_key.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace touchtrial::simulation {

/// A field with the label of its class, from one image and one method. Refers to the source.
struct LabelledField {
  std::string label;
  study::StimulusIndex stimulus{};
  const session::StimulusSource* source = nullptr;
  std::string code{};

  /// \param gain_db  re the pack's gain
  [[nodiscard]] engine::RenderingModel model(double gain_db) const {
    return source->model(code, gain_db);
  }
};

/// Every presented stimulus of a study by label, ordered by class, image and method. Only training
/// and planning access fields by label, never the code that runs trials. The source must outlive
/// it.
class LabelledFields {
 public:
  /// \throws FileError if the pack lacks a stimulus of the study
  LabelledFields(const study::StudyCodes& key, const session::StimulusSource& source);

  [[nodiscard]] const std::vector<LabelledField>& all() const noexcept { return fields_; }
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }
  /// Draws a gain like those of trials, dB re the pack's.
  [[nodiscard]] double draw_gain_db(RandomStream random) const;

 private:
  std::vector<LabelledField> fields_;
  PlaneGeometry plane_;
  study::TrialOptions trials_;
};

/// Remembered explorations. An example's label is the index of its prototype, which is one
/// labelled field.
struct FeltKnowledge {
  std::vector<engine::FeltExample> examples;
  /// Class labels, in the order of LabelledFields::all.
  std::vector<std::string> label_of_prototype;
};

/// Explores every labelled field `training_passes` times, with the device and servo of the trials.
/// Each pass has its own path and, if gains are roved, its own gain. Both are the same on every
/// field, and no trial has the path of a pass. The result depends on all arguments except `jobs`.
/// \param max_force_n  limit of the servo's force, N
/// \param jobs  threads, >= 1
[[nodiscard]] FeltKnowledge learn_by_feeling(const LabelledFields& fields,
                                             const SubjectModel& subject, double max_force_n,
                                             std::uint64_t seed, int jobs);

}  // namespace touchtrial::simulation

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

/// A field with the name of its class: one image of the class by one method. Refers to the source.
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

/// The only way to a field by its label, which the code of trials does not have. Holds every
/// presented stimulus of a study, ordered by class, image and method. Refers to the source, which
/// must outlive it.
class LabelledFields {
 public:
  /// \throws FileError if the pack lacks a stimulus of the study
  LabelledFields(const study::StudyCodes& key, const session::StimulusSource& source);

  [[nodiscard]] const std::vector<LabelledField>& all() const noexcept { return fields_; }
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }
  /// A gain as trials have them, dB re the pack's.
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
  std::vector<std::string>
      label_of_prototype;  ///< class label, in the order of LabelledFields::all
};

/// Feels every labelled field `training_passes` times, with the device and servo of the trials.
/// Each pass has its own path and, where gains are roved, its own gain. They are the same on every
/// field, and the path differs from those of all trials. A function of its arguments, except for
/// `jobs`.
/// \param max_force_n  limit of the servo's force, N
/// \param jobs  threads, >= 1
[[nodiscard]] FeltKnowledge learn_by_feeling(const LabelledFields& fields,
                                             const SubjectModel& subject, double max_force_n,
                                             std::uint64_t seed, int jobs);

}  // namespace touchtrial::simulation

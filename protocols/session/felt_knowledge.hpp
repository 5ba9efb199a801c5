/// \file What a simulated participant learns before the first trial: how each class feels.
#pragma once

#include "engine/perception/felt_classifier.hpp"
#include "protocols/session/labelled_fields.hpp"
#include "protocols/session/subject_model.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace touchtrial::session {

/// Remembered explorations; an example's label is its prototype, and prototypes have class labels.
struct FeltKnowledge {
  std::vector<engine::FeltExample> examples;
  std::vector<std::string> label_of_prototype;
};

/// Feels every labelled field `training_passes` times, through the device and servo of the trials.
/// Each pass has a path of its own that no trial has, the same on every field. A function of its
/// arguments.
/// \param max_force_n  limit of the servo's force
/// \param jobs  threads, >= 1; the result does not depend on them
[[nodiscard]] FeltKnowledge learn_by_feeling(const LabelledFields& fields,
                                             const SubjectModel& subject, double max_force_n,
                                             std::uint64_t seed, int jobs);

}  // namespace touchtrial::session

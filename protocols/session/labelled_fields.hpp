/// \file The only way to a field by its label. For a simulated participant who learns the classes
/// before the first trial; the trial path does not have it.
#pragma once

#include "protocols/design/study_key.hpp"
#include "protocols/session/stimulus_source.hpp"

#include <string>
#include <vector>

namespace touchtrial::session {

/// One thing that can be felt under a name: a class by one of its images and one method.
struct LabelledField {
  std::string label;
  const engine::RenderingModel* model = nullptr;
  design::StimulusIndex stimulus{};
};

/// Every presented stimulus of a study with its label, by class, image and method. Refers to the
/// source, which must outlive it.
class LabelledFields {
 public:
  /// \throws FileError if the pack lacks a stimulus of the study
  LabelledFields(const design::StudyKey& key, const StimulusSource& source);

  [[nodiscard]] const std::vector<LabelledField>& all() const noexcept { return fields_; }
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }

 private:
  std::vector<LabelledField> fields_;
  PlaneGeometry plane_;
};

}  // namespace touchtrial::session

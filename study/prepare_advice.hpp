/// \file Descriptions and warnings that `prepare` prints. Private to study.
#pragma once

#include "engine/rendering/gains.hpp"
#include "study/prepare.hpp"
#include "study/stimulus_field.hpp"

#include <span>
#include <string>
#include <vector>

namespace touchtrial::study {

/// Describes a stimulus by class, image and method.
[[nodiscard]] std::string stimulus_words(const Study& study, const StimulusIndex& stimulus);

/// Methods of the study file that the protocol does not present.
/// \param pixels  total number of pixels of the study's images
[[nodiscard]] std::vector<SkippedWork> skipped_work(const Study& study, std::uintmax_t pixels);

/// Warnings about options that are permitted but probably unintended.
[[nodiscard]] std::vector<std::string> rendering_warnings(const engine::RenderingOptions& rendering,
                                                          const engine::StudyGains& gains);

/// Warnings about a validity rule that no trial of the study can meet.
[[nodiscard]] std::vector<std::string> validity_warnings(const Study& study);

/// \return a warning if the solver stopped before it converged on the stimulus, else empty
[[nodiscard]] std::string solver_warning(const Study& study, const StimulusIndex& stimulus,
                                         const BuiltField& built);

/// Warnings about images with identical pixels, which no participant could tell apart.
/// \param pixels  a digest of each image, in the study's order of classes and images
[[nodiscard]] std::vector<std::string> duplicate_warnings(const Study& study,
                                                          std::span<const Digest> pixels);

/// \return a warning if labels of classes may look alike (remark_on_alphabets), else empty
[[nodiscard]] std::string label_warning(const Study& study);

}  // namespace touchtrial::study

/// \file What a simulated participant sits in with: knowledge of the textures, and a way for time
/// to go.
#pragma once

#include "app/run/run_options.hpp"
#include "app/run/run_study.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/session/felt_knowledge.hpp"
#include "protocols/session/session_clock.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/session/subject_model.hpp"
#include "protocols/store/payload.hpp"

#include <chrono>
#include <memory>

namespace touchtrial::app {

/// A subject model that has learnt the study's classes.
struct SimulatedSitter {
  session::SubjectModel subject;
  session::FeltKnowledge knowledge;
};
/// Takes half a second or so. \throws as subject_for
[[nodiscard]] SimulatedSitter simulated_sitter_for(const RunOptions& options, const RunStudy& study,
                                                   const session::StimulusSource& source);

/// How time goes in a simulated participant's session: virtual, or real if that was asked for.
struct SimulatedCourse {
  std::unique_ptr<session::Explorer> explorer;
  /// What the session's first event says of the device.
  void describe(store::SessionOpening& opening) const;
  [[nodiscard]] std::unique_ptr<session::SessionClock> clock(std::chrono::nanoseconds start) const;
};
[[nodiscard]] SimulatedCourse simulated_course(const RunOptions& options);

}  // namespace touchtrial::app

/// \file The trace of one trial: measures of its samples, the validity rule, and the evidence that
/// is stored with the answer.
#pragma once

#include "protocols/session/exploration.hpp"
#include "protocols/session/session.hpp"
#include "record/session_bodies.hpp"
#include "record/trace.hpp"

#include <chrono>
#include <cstdint>
#include <future>
#include <optional>
#include <vector>

namespace touchtrial::session {

struct TrialFindings {
  record::TrialMeasures measures;
  /// Whether the exploration lasted long enough. It depends on the number of samples and the time
  /// of landing, not on forces, and is stored unencrypted.
  bool long_enough = false;
  /// Whether duration, path along the plane, mean normal force and mean speed were within the
  /// limits of the rule and the instructions, while the hand was at most kLandingHeightMm above the
  /// plane. None depends on the texture unless the texture impedes the hand: over a second, the
  /// mean force equals the hand's push, regardless of relief, lateral force and force limit.
  /// Stored unencrypted. Source: docs/decisions/0054-what-a-trial-shows.md.
  record::HandWindows hand{};
  bool saturated = false;  ///< whether the share of saturated samples exceeds the rule's; sealed

  /// Whether the rule is met, except for its condition that no tick in contact is missing, which is
  /// not checked here.
  [[nodiscard]] bool is_valid() const noexcept { return long_enough && measures.within_limits; }
};

/// A sample has contact if its normal force is above zero; it is saturated if the norm of its force
/// is within 0.1 % of the limit. The stylus has landed at the first sample that is not above
/// kLandingHeightMm.
/// \param max_force_n  limit of the norm of the force, > 0
[[nodiscard]] TrialFindings findings_of(const record::Trace& trace, double max_force_n,
                                        const study::ValidityRule& rule = {});

/// The evidence of a trial, and whether the trial was valid.
struct JudgedEvidence {
  record::TrialEvidence evidence;
  bool valid = false;
};

/// The trace of the current presentation, with one or more explorations. The next presentation
/// reuses its memory. Used only on the session's thread.
class TrialTrace {
 public:
  /// Begins a new presentation.
  void begin();
  /// The trace of the next exploration, for the explorer. Waits until packing is over.
  [[nodiscard]] record::Trace& next_part();
  /// Appends the exploration whose trace `next_part` returned.
  /// \param began  time of its first tick, since the presentation began
  void add(const Exploration& exploration, std::chrono::nanoseconds began);
  /// Duration of the explorations in ticks of the servo's clock.
  [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }

  /// Starts evaluating and packing all samples while the participant answers.
  /// \param session  must outlive this
  /// \param in_background  whether to use another thread. Nothing may wait for it, because the
  ///   duration differs between textures.
  void pack(const Session& session, bool in_background);
  /// Waits for `pack` and returns its result. Call once for each `pack`.
  /// \throws exceptions of packing
  [[nodiscard]] JudgedEvidence take_evidence() { return packing_.get(); }

 private:
  [[nodiscard]] record::TraceBody body(int trial) const;
  [[nodiscard]] JudgedEvidence evaluate(const Session& session, int trial) const;

  record::Trace trace_;
  record::Trace later_trace_;               ///< of an exploration after the first
  std::vector<std::int64_t> explorations_;  ///< number of samples of each
  std::vector<std::int64_t> began_ns_;      ///< start of each, since the presentation began
  std::int64_t ticks_ = 0;
  std::int64_t overruns_ = 0;
  std::int64_t limited_ticks_ = 0;
  std::int64_t held_in_contact_ = 0;
  double force_limit_n_ = 0.0;
  std::optional<record::ServoHealth> health_;
  std::future<JudgedEvidence> packing_;
};

}  // namespace touchtrial::session

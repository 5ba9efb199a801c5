/// \file The trace of one trial: measures of its samples, the rule for a valid trial, and the
///   evidence that is stored with the answer.
#pragma once

#include "protocols/session/exploration.hpp"
#include "protocols/session/session.hpp"
#include "record/payload.hpp"
#include "record/trace.hpp"

#include <chrono>
#include <cstdint>
#include <future>
#include <optional>
#include <vector>

namespace touchtrial::session {

struct TrialFindings {
  record::TrialMeasures measures;
  /// Derived from the number of samples and the time of landing, which do not depend on forces. In
  /// clear.
  bool long_enough = false;
  /// By the rule's windows and the speeds of the instructions, while the hand was at the plane, at
  /// most kLandingHeightMm above it: duration, path along the plane, mean force across it, and mean
  /// speed. None depends on the texture unless it holds the hand back: over a second the mean force
  /// equals the hand's push, whatever the relief, the lateral force or the force limit. In clear.
  /// Source: docs/decisions/0054-what-a-trial-shows.md.
  record::HandWindows hand{};
  bool saturated = false;  ///< by the rule's share; sealed

  /// Whether the whole rule is met, except that no tick in contact may be missing.
  [[nodiscard]] bool valid() const noexcept { return long_enough && measures.within_limits; }
};

/// A sample has contact if its normal force is above zero; it is saturated if the norm of its force
/// is within 0.1 % of the limit. The stylus has landed at the first sample that is not above
/// kLandingHeightMm.
/// \param max_force_n  limit of the norm of the force, > 0
[[nodiscard]] TrialFindings findings_of(const record::Trace& trace, double max_force_n,
                                        const study::ValidityRule& rule = {});

/// Evidence, and whether the trial was valid.
struct JudgedEvidence {
  record::TrialEvidence evidence;
  bool valid = false;
};

/// The trace of the current presentation, of one exploration or several. Its memory is reused by
/// the next presentation. Belongs to the session's thread.
class TrialTrace {
 public:
  /// Begins a new presentation.
  void begin();
  /// The trace of the next exploration, for the explorer. Waits until packing is over.
  [[nodiscard]] record::Trace& next_part();
  /// Appends that exploration.
  /// \param began  its first tick, since the presentation began
  void add(const Exploration& done, std::chrono::nanoseconds began);
  /// Ticks of the servo's clock that the explorations took.
  [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }

  /// Begins to judge and pack all samples, while the participant answers.
  /// \param session  must outlive this
  /// \param beside  on another thread. The duration differs between textures, so nothing may wait
  ///   for it.
  void pack(const Session& session, bool beside);
  /// The result of `pack`, once.
  /// \throws whatever packing threw
  [[nodiscard]] JudgedEvidence take_evidence() { return packing_.get(); }

 private:
  [[nodiscard]] record::TraceBody body(int trial) const;
  [[nodiscard]] JudgedEvidence judged(const Session& session, int trial) const;

  record::Trace trace_;
  record::Trace more_;                      ///< of an exploration after the first
  std::vector<std::int64_t> explorations_;  ///< samples of each
  std::vector<std::int64_t> began_ns_;      ///< of each, since the presentation began
  std::int64_t ticks_ = 0;
  std::int64_t overruns_ = 0;
  std::int64_t limited_ticks_ = 0;
  std::int64_t held_in_contact_ = 0;
  double force_limit_n_ = 0.0;
  std::optional<record::ServoHealth> health_;
  std::future<JudgedEvidence> packing_;
};

}  // namespace touchtrial::session

/// \file What one presentation's explorations leave behind, and its evidence, packed while the
/// participant answers. Private to the runner.
#pragma once

#include "protocols/session/exploration.hpp"
#include "protocols/session/session.hpp"

#include <cstdint>
#include <future>
#include <optional>
#include <vector>

namespace touchtrial::session {

/// Evidence, and whether the trial was valid.
struct JudgedEvidence {
  store::TrialEvidence evidence;
  bool valid = false;
};

/// One at a time; its memory is used again.
class ExplorationRecord {
 public:
  /// A new presentation.
  void begin();
  /// Where the explorer puts the next exploration's samples. Waits for a packing that is under way.
  [[nodiscard]] store::Trace& next_trace();
  /// That exploration is over.
  void add(const Exploration& done);
  /// Ticks of the servo's clock that the explorations took.
  [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }

  /// Begins to pack all samples so far. \param session  must outlive this
  /// \param beside  on another thread: how long it takes tells textures apart and should let nobody
  ///   wait
  void pack(const Session& session, bool beside);
  /// What came of it; once. Throws what packing threw.
  [[nodiscard]] JudgedEvidence take() { return packing_.get(); }

 private:
  [[nodiscard]] store::TraceBody body(int trial) const;
  [[nodiscard]] JudgedEvidence judged(const Session& session, int trial) const;

  store::Trace trace_;
  store::Trace more_;  ///< of the exploration after the first
  std::vector<std::int64_t> explorations_;
  std::int64_t ticks_ = 0;
  std::int64_t overruns_ = 0;
  std::int64_t limited_ticks_ = 0;
  std::int64_t held_in_contact_ = 0;
  double force_limit_n_ = 0.0;
  std::optional<store::ServoHealth> health_;
  std::future<JudgedEvidence> packing_;
};

}  // namespace touchtrial::session

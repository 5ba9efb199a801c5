/// \file One exploration: servo, force model, participant, trace. How time goes is the explorer's.
#pragma once

#include "device/servo/servo.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/session/trace_builder.hpp"
#include "protocols/store/payload.hpp"
#include "protocols/store/trace.hpp"

#include <chrono>
#include <cstdint>
#include <optional>

namespace touchtrial::session {

/// What came of an exploration.
struct Exploration {
  device::ServoReport servo;
  std::optional<std::chrono::nanoseconds> landed_at;  ///< since plane-on
  std::chrono::nanoseconds lasted{};                  ///< on the servo's clock
  /// When the servo started, in real time: its ticks are counted from here.
  std::optional<std::chrono::steady_clock::time_point> began;
  std::int64_t held_in_contact = 0;  ///< samples of the trace that were filled in, with contact
  std::optional<store::ServoHealth> health;         ///< in real time
  std::optional<store::InterruptionDetail> detail;  ///< of one that was interrupted in real time
};

/// Runs explorations. The participant gets the plane's extent and the samples, and nothing else.
class Explorer {
 public:
  virtual ~Explorer() = default;

  /// Whether a disk that is waited for would be felt: then every field is to be in memory before.
  [[nodiscard]] virtual bool in_real_time() const noexcept { return false; }
  /// Puts a plane before a participant until the hand stops, time is up, or something fails. The
  /// last force written is zero. \param trace  gets every sample; its memory is used again
  [[nodiscard]] virtual Exploration explore(const engine::RenderingModel& model,
                                            const PlaneGeometry& plane, Participant& participant,
                                            const device::ServoOptions& options,
                                            store::Trace& trace) = 0;
};

/// As fast as the processor goes, on the calling thread: for hands that live in virtual time.
class VirtualExplorer final : public Explorer {
 public:
  [[nodiscard]] Exploration explore(const engine::RenderingModel& model, const PlaneGeometry& plane,
                                    Participant& participant, const device::ServoOptions& options,
                                    store::Trace& trace) override;
};

/// Samples that an exploration can have.
[[nodiscard]] std::size_t most_samples(const device::ServoOptions& options) noexcept;

}  // namespace touchtrial::session

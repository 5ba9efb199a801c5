/// \file The thread that takes samples from the servo's ring into the trace.
#pragma once

#include "device/servo/sample_ring.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/session/trace_builder.hpp"

#include <atomic>
#include <thread>

namespace touchtrial::session {

/// Empties a ring while the servo fills it, as long as it lives: samples go to the trace, which
/// fills gaps, and to the participant who feels. Made and finished on one thread.
class TraceWriter {
 public:
  /// All must outlive this, and nobody else may use builder and `feel` until `finish`.
  TraceWriter(device::SampleRing& ring, TraceBuilder& builder, Participant& participant);
  ~TraceWriter() { finish(); }
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  /// Takes what is left in the ring and ends the thread. Call once the servo has ended.
  void finish() noexcept;

 private:
  void write() noexcept;
  /// \return whether there was anything
  bool take_some() noexcept;

  device::SampleRing& ring_;
  TraceBuilder& builder_;
  Participant& participant_;
  std::atomic<bool> finishing_{false};
  std::thread thread_;
};

}  // namespace touchtrial::session

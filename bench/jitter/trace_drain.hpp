/// \file The writer beside the measured servo: empties the ring and makes traces of the samples.
#pragma once

#include "device/servo/sample_ring.hpp"
#include "protocols/store/trace.hpp"

#include <atomic>
#include <cstdint>
#include <span>
#include <thread>

namespace touchtrial::bench::jitter {

/// A thread that takes samples out of a ring and encodes them as a session stores them, in traces
/// of a minute at 1 kHz. The traces are let go of.
class TraceDrain {
 public:
  /// \param ring  must outlive this
  explicit TraceDrain(device::SampleRing& ring);
  ~TraceDrain();
  TraceDrain(const TraceDrain&) = delete;
  TraceDrain& operator=(const TraceDrain&) = delete;

  struct Totals {
    std::int64_t samples = 0;
    std::int64_t bytes = 0;  ///< of the encoded traces
  };
  /// Takes what is left in the ring, into which nothing may come any more, and ends the thread.
  Totals finish();

 private:
  void drain();
  void keep(std::span<const device::ServoSample> samples);
  void encode();

  device::SampleRing& ring_;
  store::Trace trace_;
  Totals totals_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace touchtrial::bench::jitter

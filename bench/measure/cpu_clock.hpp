/// \file Time that this process has spent computing, in all its threads. What others do on the
/// machine does not count, but for what they do to the caches.
#pragma once

namespace touchtrial::bench {

/// Microseconds since some moment; the difference of two readings is a time.
[[nodiscard]] double cpu_clock_us() noexcept;

}  // namespace touchtrial::bench

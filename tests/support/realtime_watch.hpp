/// \file Counts allocations and locks, which are forbidden in the servo's loop. Linking it replaces
/// the C library's malloc family (and so operator new) and locks by counting functions.
#pragma once

#include <cstdint>

namespace touchtrial {

/// Calls of threads inside a RealtimeRegion.
struct RealtimeOffences {
  std::int64_t allocations = 0;
  std::int64_t frees = 0;
  std::int64_t locks = 0;  ///< of mutexes and reader-writer locks

  friend bool operator==(const RealtimeOffences&, const RealtimeOffences&) = default;
};

/// Offences of all threads since the last call.
[[nodiscard]] RealtimeOffences take_realtime_offences() noexcept;

/// Whether locks are counted. Sanitizers replace the locks themselves; with them only allocations
/// are counted, by the sanitizers' hooks.
[[nodiscard]] bool locks_are_watched() noexcept;

}  // namespace touchtrial

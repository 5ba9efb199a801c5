/// \file Counts what the servo's loop must never do. Linking it puts counting functions in the
/// place of the C library's: malloc and its kin, operator new through them, and the locks.
#pragma once

#include <cstdint>

namespace touchtrial {

/// What threads did while they were inside a RealtimeRegion.
struct RealtimeOffences {
  std::int64_t allocations = 0;
  std::int64_t frees = 0;
  std::int64_t locks = 0;  ///< of mutexes and reader-writer locks

  friend bool operator==(const RealtimeOffences&, const RealtimeOffences&) = default;
};

/// Those of all threads since the last call.
[[nodiscard]] RealtimeOffences take_realtime_offences() noexcept;

/// Whether locks are counted: sanitizers have their own functions in those places, which must stay.
/// Allocations are counted there by the sanitizers' hooks.
[[nodiscard]] bool locks_are_watched() noexcept;

}  // namespace touchtrial

/// \file Marks the code in which nothing may allocate, lock or do I/O, so that tests can tell.
#pragma once

namespace touchtrial::device {

/// The calling thread is in the servo's loop while one of these lives. The servo enters once a run,
/// so it costs nothing; tests watch allocations and locks of threads that are inside.
class RealtimeRegion {
 public:
  RealtimeRegion() noexcept;
  ~RealtimeRegion();
  RealtimeRegion(const RealtimeRegion&) = delete;
  RealtimeRegion& operator=(const RealtimeRegion&) = delete;

  /// Whether the calling thread is inside one. Allocates nothing.
  [[nodiscard]] static bool entered() noexcept;
};

}  // namespace touchtrial::device

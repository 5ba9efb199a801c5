/// \file What the mouse device is given, and what it gives back: a pointer on the plane, from
/// whoever owns a window. No window library here.
#pragma once

#include "core/vec.hpp"

#include <cstdint>

namespace touchtrial::device {

/// The person's own pointer, as its window saw it last.
struct PointerState {
  Vec2 position_mm;      ///< on the plane, from its top-left corner
  bool pressed = false;  ///< the button is held
  bool closed = false;   ///< the window is gone and will not come back
  /// Counts the window's rounds, whether or not the pointer has moved; 0: it has not begun. A
  /// number that stands still tells of a window that hangs.
  std::uint64_t sequence = 0;
};

/// What the window draws in the pointer's place.
struct StylusState {
  Vec2 position_mm;
  std::uint64_t sequence = 0;  ///< counts the device's readings; 0: it has not begun
};

/// The servo's side of a pointer. Both functions belong to the servo thread and never wait for the
/// window: no lock, heap or I/O.
class PointerSource {
 public:
  virtual ~PointerSource() = default;
  [[nodiscard]] virtual PointerState newest() noexcept = 0;
  virtual void show(const StylusState& stylus) noexcept = 0;
};

}  // namespace touchtrial::device

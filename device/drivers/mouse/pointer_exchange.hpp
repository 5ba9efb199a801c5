/// \file Passes the pointer's state from a window to the mouse device, and the stylus' state back.
///   Independent of any window library.
#pragma once

#include "core/vec.hpp"
#include "device/servo/latest_value.hpp"

#include <cstdint>

namespace touchtrial::device {

/// The last state of the user's pointer in the window.
struct PointerState {
  Vec2 position_mm;      ///< on the plane, from its top-left corner
  bool pressed = false;  ///< the button is held
  bool closed = false;   ///< the window was closed
  /// Counts the window's iterations, even if the pointer has not moved; 0: none yet. A constant
  /// number means that the window hangs.
  std::uint64_t sequence = 0;
};

/// The stylus, which the window draws instead of the pointer.
struct StylusState {
  Vec2 position_mm;
  std::uint64_t sequence = 0;  ///< counts the device's readings; 0: none yet
};

/// The servo's side of a pointer. Both functions belong to the servo thread and never wait for the
/// window: no lock, heap or I/O.
class PointerSource {
 public:
  virtual ~PointerSource() = default;
  [[nodiscard]] virtual PointerState newest() noexcept = 0;
  virtual void show(const StylusState& stylus) noexcept = 0;
};

/// The PointerSource for windows. Neither thread ever blocks the other.
class PointerExchange final : public PointerSource {
 public:
  /// \name Servo thread
  ///@{
  [[nodiscard]] PointerState newest() noexcept override { return pointers_.get(); }
  void show(const StylusState& stylus) noexcept override { styluses_.set(stylus); }
  ///@}

  /// \name Window's thread
  /// @{ Numbers a state and passes it to the servo. Call it once per iteration, even if the pointer
  /// has not moved.
  void publish(PointerState pointer) noexcept {
    pointer.sequence = ++published_;
    pointers_.set(pointer);
  }
  [[nodiscard]] StylusState stylus() noexcept { return styluses_.get(); }
  ///@}

 private:
  LatestValue<PointerState> pointers_;
  LatestValue<StylusState> styluses_;
  std::uint64_t published_ = 0;
};

}  // namespace touchtrial::device

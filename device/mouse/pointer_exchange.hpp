/// \file A pointer handed from a window's thread to the servo's, and the stylus back.
#pragma once

#include "device/latest_value.hpp"
#include "device/mouse/pointer_source.hpp"

namespace touchtrial::device {

/// The PointerSource of every window: neither thread ever waits for the other.
class PointerExchange final : public PointerSource {
 public:
  /// \name Servo thread
  ///@{
  [[nodiscard]] PointerState newest() noexcept override { return pointers_.get(); }
  void show(const StylusState& stylus) noexcept override { styluses_.set(stylus); }
  ///@}

  /// \name Window's thread
  ///@{
  /// Once a round, whether or not the pointer has moved; numbers the state itself.
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

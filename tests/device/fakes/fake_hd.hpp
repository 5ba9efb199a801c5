/// \file A test's settings for the fake libHD, and the calls that the fake observed. Where each
/// behaviour comes from stands in fake_hd.cpp.
#pragma once

#include "device/fakes/fake_parts.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

namespace touchtrial::fakes {

/// The names by which the fake's one device opens, as bits.
enum HdName : unsigned {
  kHdNull = 1,
  kHdDefaultDevice = 2,
  kHdDefaultPhantom = 4,
  kHdLabTouch = 8
};

/// The bits of HD_CALIBRATION_STYLE.
enum HdStyle : int { kHdEncoderReset = 1, kHdAuto = 2, kHdInkwell = 4 };

struct FakeHd {
  // Orders.
  std::atomic<unsigned> opens_by{kHdNull};
  std::atomic<int> calibration_styles{kHdInkwell};  ///< those that the device supports
  std::atomic<bool> calibrated{true};               ///< since it was plugged in
  std::atomic<bool> in_inkwell{false};              ///< the stylus
  std::atomic<int> failing_updates{0};              ///< of a calibration, from now on
  std::atomic<bool> has_news{false};  ///< a device of the style auto was moved and has learnt
  /// How far the encoders are off until a calibration: position read is the hand's less this.
  SharedVec encoder_error_mm;
  std::atomic<std::uint32_t> next_error{0};  ///< pushed once, at the end of a frame
  std::atomic<bool> lost{false};             ///< every frame is a communication error
  std::atomic<bool> tells_temperature{true};
  std::atomic<bool> tells_damping{true};
  std::atomic<bool> tells_usable_workspace{true};
  std::atomic<bool> tells_max_workspace{true};
  std::array<std::atomic<double>, 6> warmth{};
  std::atomic<int> buttons{0};
  std::atomic<bool> hold_callback{false};  ///< inside the library, while set
  std::atomic<bool> lazy_stop{false};      ///< stopping the scheduler does not wait for callbacks
  FakeHand hand;

  // Observations.
  std::atomic<bool> callback_held{false};
  std::atomic<long> frames{0};
  std::atomic<long> zero_forces_last{0};  ///< in a row, until now
  std::atomic<long> misuses{0};           ///< nested frames, forces outside, calls after the end
  std::atomic<int> calibration_updates{0};
  std::atomic<int> last_style{0};
  SharedVec force_n;  ///< on the hand
};

/// What the fake exports beside libHD's own names.
struct FakeHdExports {
  FakeHd* state;
  void (*reset)();
  bool (*step)(int ticks);
  void (*run_freely)();
  std::string (*calls)();  ///< the names of opening and closing calls, in order
};

}  // namespace touchtrial::fakes

extern "C" touchtrial::fakes::FakeHdExports* fake_hd_exports();

/// \file The emulated Falcon on a USB bus inside the program, for judge_shim.cpp: the maker's
/// library finds it, loads its firmware and drives it as it would a real one. The shim has to be
/// preloaded, so that libusb finds the bus. Vectors are in the maker's frame.
#pragma once

#include "core/vec.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::testing {

/// The hand's place, m, under a force of the motors, N, by the maker's motor values for 1 N m.
/// Called in each exchange, by the thread that makes it.
using JudgedHand = std::function<Vec3(Vec3 force_n)>;

/// What our own driver, falcon, would make of a force and of the encoders.
struct OurFalcon {
  Vec3 position_m;
  double share = 0.0;  ///< of the maker's motor values for this force to ours
  double rest = 0.0;   ///< the largest motor value that this share leaves
};

/// \name One thread at a time
///@{
/// Plugs the Falcon in, when first called. A motion of a second homes its axes; then the hand holds
/// it.
/// \param homed  by an earlier program: the hand holds it from the beginning
void plug_falcon(JudgedHand hand, bool homed);
[[nodiscard]] bool is_falcon_homed();
[[nodiscard]] Vec3 falcon_position_m();
[[nodiscard]] bool falcon_pushes();
/// \param force_n  that the maker's library was asked for, with the weight that it adds
[[nodiscard]] std::optional<OurFalcon> our_falcon(Vec3 force_n);
/// \return the firmware's bytes
[[nodiscard]] int falcon_firmware_bytes();
[[nodiscard]] std::vector<std::string> falcon_complaints();
///@}

}  // namespace touchtrial::testing

/// \file The weight that Force Dimension's library adds to every force. Private to this folder.
#pragma once

#include "core/vec.hpp"
#include "device/drivers/dhd/dhd_library.hpp"

#include <optional>

namespace touchtrial::device::dhd {

constexpr double kStandardGravityMS2 = 9.80665;

/// The force with which the library supports arms and end-effector at their current position. The
/// library reports the joint torques t and the Jacobian J of position by joint angles; the
/// equivalent force at the end-effector solves J^T F = t. Does not allocate or throw.
/// \param device  open and calibrated, with gravity compensation on; for a short time after it is
///   switched off, the library still reports a part
/// \return DHD's frame, N; nothing if the library does not report it
[[nodiscard]] std::optional<Vec3> compensated_weight_n(const Api& api, char device) noexcept;

/// \param force_n  DHD's frame
/// \param max_n  > 0
/// \return whether the force may support a weight: finite, upwards, and at most max_n
[[nodiscard]] bool is_plausible_weight(Vec3 force_n, double max_n) noexcept;

}  // namespace touchtrial::device::dhd

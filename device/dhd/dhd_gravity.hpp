/// \file The weight of a Force Dimension device, as its library models it. Private to this folder.
#pragma once

#include "core/vec.hpp"
#include "device/dhd/dhd_library.hpp"

#include <optional>

namespace touchtrial::device::dhd {

constexpr double kStandardGravityMS2 = 9.80665;

/// The force that carries arms and end-effector, so that the servo can add it before the safety
/// chain. Left to itself, the library would add it to every force, behind the chain.
///
/// The library gives the torques t of the joints that hold the device where it is, and the Jacobian
/// J of the position by the joints' angles. The force with the same effect at the end-effector
/// solves J^T F = t. A library without these functions tells only the end-effector's mass.
/// Nothing here allocates or throws.
class Gravity {
 public:
  /// \param api  must outlive this
  /// \param device  open
  /// \param mass_kg  of the end-effector, used where the library has no model
  /// \param most_n  > 0; a larger force is nonsense
  Gravity(const Api& api, char device, double mass_kg, double most_n) noexcept
      : api_(api), device_(device), mass_kg_(mass_kg), most_n_(most_n) {}

  /// The device must be calibrated.
  /// \return the force in DHD's frame, N; nothing if the library refuses or its answer is no weight:
  ///   not finite, pointing down or sideways, or larger than most_n
  [[nodiscard]] std::optional<Vec3> force_n() const noexcept;

 private:
  const Api& api_;
  char device_;
  double mass_kg_;
  double most_n_;
};

/// \return the F with J^T F = t, by Cramer's rule; nothing where J has no inverse
/// \param jacobian  J: rows are x, y and z, columns the joints
[[nodiscard]] std::optional<Vec3> force_of_torques(const double (&jacobian)[3][3],
                                                   Vec3 torques_nm) noexcept;

}  // namespace touchtrial::device::dhd

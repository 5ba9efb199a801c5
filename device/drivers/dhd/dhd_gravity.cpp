#include "device/drivers/dhd/dhd_gravity.hpp"

#include <array>
#include <cmath>

namespace touchtrial::device::dhd {
namespace {

/// The horizontal share of a weight that is allowed, because the base may not be level.
constexpr double kSidewaysShare = 0.3;
constexpr double kSlackN = 0.2;  ///< tolerance for rounding

constexpr unsigned char kAllJoints = 0xff;

/// The angles of the arms, and the torques that hold them.
struct ArmJoints {
  std::array<double, 3> angles_rad{};
  Vec3 torques_nm;
};

constexpr Vec3 cross(Vec3 a, Vec3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

bool has_new_functions(const Api& api) noexcept {
  return api.get_joint_angles != nullptr && api.joint_angles_to_gravity_joint_torques != nullptr;
}

bool has_old_functions(const Api& api) noexcept {
  return api.get_delta_joint_angles != nullptr && api.delta_gravity_joint_torques != nullptr;
}

/// Uses the functions for all joints, since version 3.16; older versions cover only the arms.
std::optional<ArmJoints> joints_from_new_functions(const Api& api, char device) noexcept {
  std::array<double, kJoints> angles{};
  std::array<double, kJoints> torques{};
  if (api.get_joint_angles(angles.data(), device) < 0 ||
      api.joint_angles_to_gravity_joint_torques(angles.data(), torques.data(), kAllJoints, device) <
          0) {
    return std::nullopt;
  }
  return ArmJoints{{angles[0], angles[1], angles[2]}, {torques[0], torques[1], torques[2]}};
}

std::optional<ArmJoints> joints_from_old_functions(const Api& api, char device) noexcept {
  ArmJoints joints;
  auto& [a, b, c] = joints.angles_rad;
  Vec3& torques = joints.torques_nm;
  if (api.get_delta_joint_angles(&a, &b, &c, device) < 0 ||
      api.delta_gravity_joint_torques(a, b, c, &torques.x, &torques.y, &torques.z, device) < 0) {
    return std::nullopt;
  }
  return joints;
}

/// Solves J^T F = t by Cramer's rule.
/// \param jacobian  rows are x, y and z, columns the joints
std::optional<Vec3> force_of_torques(const double (&jacobian)[3][3], Vec3 torques_nm) noexcept {
  // Columns of J, which are the rows of J^T.
  const Vec3 a{jacobian[0][0], jacobian[1][0], jacobian[2][0]};
  const Vec3 b{jacobian[0][1], jacobian[1][1], jacobian[2][1]};
  const Vec3 c{jacobian[0][2], jacobian[1][2], jacobian[2][2]};
  const double volume = dot(a, cross(b, c));
  if (!(std::abs(volume) > 1e-9 * norm(a) * norm(b) * norm(c))) return std::nullopt;
  return (1.0 / volume) *
         (torques_nm.x * cross(b, c) + torques_nm.y * cross(c, a) + torques_nm.z * cross(a, b));
}

std::optional<Vec3> library_weight_n(const Api& api, char device) noexcept {
  const std::optional<ArmJoints> joints = has_new_functions(api)
                                              ? joints_from_new_functions(api, device)
                                              : joints_from_old_functions(api, device);
  double jacobian[3][3] = {};
  if (!joints || api.delta_joint_angles_to_jacobian(joints->angles_rad[0], joints->angles_rad[1],
                                                    joints->angles_rad[2], jacobian, device) < 0) {
    return std::nullopt;
  }
  return force_of_torques(jacobian, joints->torques_nm);
}

}  // namespace

std::optional<Vec3> compensated_weight_n(const Api& api, char device) noexcept {
  const bool has_functions = api.delta_joint_angles_to_jacobian != nullptr &&
                             (has_new_functions(api) || has_old_functions(api));
  if (!has_functions) return std::nullopt;
  return as_expert(api, [&]() noexcept { return library_weight_n(api, device); });
}

bool is_plausible_weight(Vec3 force_n, double max_n) noexcept {
  return force_n.z >= -kSlackN &&
         std::hypot(force_n.x, force_n.y) <= kSidewaysShare * std::abs(force_n.z) + kSlackN &&
         norm(force_n) <= max_n;
}

}  // namespace touchtrial::device::dhd

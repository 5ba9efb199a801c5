#include "device/drivers/dhd/judge_falcon.hpp"

#include "device/drivers/falcon/emulator/falcon_emulator.hpp"
#include "device/drivers/falcon/falcon_motors.hpp"
#include "device/drivers/falcon/falcon_packet.hpp"
#include "device/drivers/falcon/usbfs_shim/usbfs_shim.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <utility>

#include <unistd.h>

namespace touchtrial::testing {
namespace {

using namespace device::falcon;

/// Of the maker's library, against kMotorValuePerNm: 4,095 for 1.098 N m.
constexpr double kMakersMotorValuePerNm = -3728.0;
/// A full-speed bus has a frame a millisecond, and the chip answers an empty read as late.
constexpr useconds_t kFrameUs = 900;
constexpr int kHomingTicks = 1000;
constexpr double kHomingTravelMm = 20.0;
constexpr double kHomingHeightMm = 10.0;  ///< where the hand takes over

Vec3 to_maker(Vec3 ours) {
  return {ours.z, ours.x, ours.y};
}
Vec3 to_ours(Vec3 maker) {
  return {maker.y, maker.z, maker.x};
}

class Falcon final : public UsbModel {
 public:
  Falcon(JudgedHand hand, bool homed)
      : hand_(std::move(hand)),
        ticks_(homed ? kHomingTicks : 0),
        emulator_({.firmware_runs = homed, .homed = homed},
                  [this](Vec3 force_n) { return move(force_n); }),
        model_(emulator_),
        plugged_(*this) {
    if (!homed) return;
    static_cast<void>(emulator_.control({0x40, FtdiChip::kLatency, 1, 0}));
    static_cast<void>(
        emulator_.control({0x40, FtdiChip::kBaudDivisor, FtdiChip::kDivisorRunning, 0}));
  }

  [[nodiscard]] bool vendor_request(std::uint8_t request, std::uint16_t value,
                                    std::uint16_t index) override {
    return model_.vendor_request(request, value, index);
  }
  void bulk_out(std::span<const std::uint8_t> bytes) override { model_.bulk_out(bytes); }
  [[nodiscard]] std::size_t bulk_in(std::span<std::uint8_t> bytes) override {
    usleep(kFrameUs);
    std::vector<std::uint8_t> transfer;
    static_cast<void>(emulator_.bulk_in(bytes.size(), transfer));
    std::ranges::copy(transfer, bytes.begin());
    before_ = seen_.newest();
    seen_.push_transfer(transfer);
    return transfer.size();
  }

  [[nodiscard]] const FalconEmulator& emulator() const { return emulator_; }
  [[nodiscard]] const Reply& newest() const { return seen_.newest(); }
  [[nodiscard]] const Reply& before() const { return before_; }

 private:
  Vec3 move(Vec3 force_n) {
    if (ticks_ < kHomingTicks) {
      const double turn = 2.0 * std::numbers::pi * ++ticks_ / kHomingTicks;
      return {0.0, kHomingHeightMm, kHomingTravelMm * std::sin(turn)};
    }
    const double scale = kMotorValuePerNm / kMakersMotorValuePerNm;
    return 1000.0 * to_ours(hand_(scale * to_maker(force_n)));
  }

  JudgedHand hand_;
  int ticks_;
  FalconEmulator emulator_;
  EmulatorUsbModel model_;
  FalconStream seen_;
  Reply before_;  ///< the reply that the newest command was made from
  ShimmedUsbDevice plugged_;
};

std::unique_ptr<Falcon>& falcon() {
  // Never destroyed: the library's last calls may outlive static objects.
  static auto* const kFalcon = new std::unique_ptr<Falcon>;
  return *kFalcon;
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

void plug_falcon(JudgedHand hand, bool homed) {
  if (!falcon()) falcon() = std::make_unique<Falcon>(std::move(hand), homed);
}

bool is_falcon_homed() {
  return falcon()->emulator().all_homed() && falcon()->newest().all_homed();
}

Vec3 falcon_position_m() {
  return 1e-3 * to_maker(falcon()->emulator().position_mm());
}

bool falcon_pushes() {
  return falcon()->emulator().motors() != MotorValues{};
}

std::optional<OurFalcon> our_falcon(Vec3 force_n) {
  const Pose pose = forward_kinematics(theta1_of_counts(falcon()->newest().counts));
  const Pose before = forward_kinematics(theta1_of_counts(falcon()->before().counts));
  const auto torques = torques_nm(before.jacobian, to_ours(force_n));
  if (!torques) return std::nullopt;
  PerLeg ours{};
  PerLeg makers{};
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ours[i] = kMotorValuePerNm * (*torques)[i];
    makers[i] = falcon()->emulator().motors()[i];
  }
  OurFalcon all{1e-3 * to_maker(to_device_mm(pose.native_m)), dot(makers, ours) / dot(ours, ours)};
  for (std::size_t i = 0; i < ours.size(); ++i) {
    all.rest = std::max(all.rest, std::abs(makers[i] - all.share * ours[i]));
  }
  return all;
}

int falcon_firmware_bytes() {
  return static_cast<int>(falcon()->emulator().image().size());
}

std::vector<std::string> falcon_complaints() {
  return falcon()->emulator().complaints();
}

}  // namespace touchtrial::testing

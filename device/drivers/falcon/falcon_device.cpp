#include "device/drivers/falcon/falcon_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/drivers.hpp"
#include "device/drivers/falcon/falcon_firmware.hpp"
#include "device/drivers/falcon/usb_falcon.hpp"

namespace touchtrial::device::falcon {
namespace {

using std::chrono::milliseconds;

constexpr int kProbes = 5;
/// At a latency of 1 ms the chip sends a packet every millisecond, usually an empty one.
constexpr int kPacketsPerProbe = 20;
constexpr milliseconds kPacketLimit{20};

/// Sends one packet.
/// \return whether there was a reply before the time limit
bool answers_once(FtdiTransport& transport) {
  const Packet question = FalconExchange::zero_packet();
  if (transport.send(question, kPacketLimit) != question.size()) return false;
  FalconStream stream;
  std::array<std::uint8_t, kUsbPacketSize> packet{};
  for (int i = 0; i < kPacketsPerProbe; ++i) {
    const std::size_t length = transport.receive(packet, kPacketLimit);
    if (length == 0) return false;
    if (stream.push_transfer(std::span(packet).first(length)) > 0) return true;
  }
  return false;
}

/// Starts the device, and loads its firmware if necessary.
void make_run(FtdiTransport& transport, const FalconSettings& settings) {
  set_up_running_falcon(transport);
  if (falcon_answers(transport)) return;
  load_falcon_firmware(transport, read_falcon_firmware(settings.firmware));
  if (falcon_answers(transport)) return;
  throw DeviceError("falcon: its firmware is loaded, but it does not answer; " +
                    one_line(settings.firmware.string()) +
                    " may not be a Falcon's firmware: correct falcon.firmware in the device "
                    "settings");
}

/// \return the fault of the firmware's file; empty if none
std::string firmware_fault(const FalconSettings& settings) {
  try {
    static_cast<void>(read_falcon_firmware(settings.firmware));
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

std::vector<DeviceListing> list_falcons(const DeviceSettings& settings) {
  std::vector<DeviceListing> listings;
  const std::string firmware = firmware_fault(settings.falcon);
  for (const UsbFalcon& found : find_usb_falcons()) {
    DeviceListing listing{"falcon", "Novint Falcon", found.serial, found.where, true, {}};
    if (!found.trouble.empty()) listing.missing.push_back(found.trouble);
    if (!firmware.empty()) listing.missing.push_back(firmware);
    listings.push_back(std::move(listing));
  }
  if (listings.empty()) {
    listings.push_back(
        {"falcon",
         "",
         "",
         "",
         false,
         {"none is plugged in (USB 0403:cb48); plug it in and switch its power on"}});
  }
  return listings;
}

std::unique_ptr<HapticDevice> open_falcon(const DeviceSettings& settings) {
  return std::make_unique<FalconDevice>(open_usb_falcon(settings.falcon.serial), settings.falcon);
}

}  // namespace

bool falcon_answers(FtdiTransport& transport) {
  for (int i = 0; i < kProbes; ++i) {
    if (answers_once(transport)) return true;
  }
  return false;
}

FalconDevice::FalconDevice(std::unique_ptr<FtdiTransport> transport, const FalconSettings& settings,
                           FalconOptions options)
    : settings_(settings),
      transport_(std::move(transport)),
      options_(std::move(options)),
      exchange_(settings, link_) {
  make_run(*transport_, settings);
  transport_->start_stream(exchange_);
  thread_ = std::thread([this] {
    scheduling_ = request_scheduling(options_.scheduling);
    started_.count_down();
    exchange_until_stopped();
  });
  started_.wait();
}

FalconDevice::~FalconDevice() {
  stopping_.store(true, std::memory_order_release);
  options_.pace->end();
  thread_.join();
}

DeviceInfo FalconDevice::info() const {
  DeviceInfo info;
  info.name = "falcon";
  info.serial = transport_->serial();
  info.model = "Novint Falcon";
  info.max_force_n = kForcePerMotorValueN * settings_.motor_peak;
  if (settings_.motor_continuous < settings_.motor_peak) {
    info.continuous_force_n = kForcePerMotorValueN * settings_.motor_continuous;
  }
  info.workspace = kFalconWorkspace;
  info.max_support_n = FalconSettings::kMaxGravityBiasN;
  info.has_encoders = true;
  return info;
}

DeviceReadiness FalconDevice::readiness() const noexcept {
  return homed_.load(std::memory_order_acquire) ? DeviceReadiness::ready
                                                : DeviceReadiness::needs_homing;
}

void FalconDevice::exchange_until_stopped() noexcept {
  FalconPace::Time next = options_.pace->now();
  while (!stopping_.load(std::memory_order_acquire) && link_.fault() == DeviceFault::none) {
    options_.pace->rest_until(next);
    next = options_.pace->now() + kPeriod;
    exchange();
  }
  send_final_zeros();
  options_.pace->end();
}

void FalconDevice::exchange() noexcept {
  // Bytes received since the last exchange do not answer this one.
  transport_->serve(std::chrono::microseconds(0));
  exchange_.publish(options_.pace->now());
  // A refused command shows as a missing reply.
  static_cast<void>(transport_->post(exchange_.begin(options_.pace->now())));
  wait_for_reply();
  exchange_.end();
  homed_.store(exchange_.homed(), std::memory_order_release);
  if (transport_->lost()) link_.fail(DeviceFault::link_lost);
}

void FalconDevice::wait_for_reply() noexcept {
  // The device answers in real time, even with a virtual clock.
  const FalconPace::Time until = monotonic_now() + kReplyLimit;
  do {
    transport_->serve(std::chrono::duration_cast<std::chrono::microseconds>(kReplyLimit));
    exchange_.publish(options_.pace->now());
    if (exchange_.is_answered() || transport_->lost()) return;
  } while (monotonic_now() < until);
  options_.pace->waited(kReplyLimit);
}

void FalconDevice::send_final_zeros() noexcept {
  transport_->stop_stream();
  try {
    for (int i = 0; i < kFinalPackets; ++i) {
      static_cast<void>(transport_->send(FalconExchange::zero_packet(), kFinalLimit));
    }
  } catch (const DeviceError&) {
    // The device was disconnected, so no final packets are sent.
  }
}

}  // namespace touchtrial::device::falcon

namespace touchtrial::device {

/// Sources of unverified facts: this driver's page in docs/devices.
DeviceDriver falcon_driver() {
  return {
      .name = "falcon",
      .what = "Novint Falcon, over USB",
      .list = falcon::list_falcons,
      .open = falcon::open_falcon,
      .nominal_workspace = falcon::kFalconWorkspace,
      .products = {{"falcon", "Novint Falcon", "falcon"}},
      .unverified = {
          {"signs", "which way positions and forces run on each axis"},
          {"lengths", "legs and degrees a count: the sources differ by 1.2 to 1.5 in lengths"},
          {"zero_angle",
           "the legs' angle at count 0 (32.99 or 35 degrees), which shifts the middle of the "
           "reach"},
          {"force_scale", "motor values for 1 N m: 6,616, or 3,728, or 10,000"},
          {"homing", "whether firmware loads and the axes home as the driver does it"},
          {"lights",
           "which bit is which light",
           "Which light was on before the grip was homed?",
           {"red", "green", "blue", "none"}},
          {"program_silent", "what the firmware does with the motors when the host falls silent"},
          {"cable_silent", "what the firmware does with the motors when the USB cable is pulled"},
          {"replies", "how late replies come on this port"},
          {"beyond_peak", "what the firmware does with motor values beyond 4,095"},
          {"warm_motors",
           "how long motors hold which torque, and how warm they get (device accept --thermal)"}}};
}

}  // namespace touchtrial::device

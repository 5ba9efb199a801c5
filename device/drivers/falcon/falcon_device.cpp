#include "device/drivers/falcon/falcon_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/drivers.hpp"
#include "device/drivers/falcon/falcon_firmware.hpp"
#include "device/drivers/falcon/usb_falcon.hpp"

namespace touchtrial::device::falcon {
namespace {

using std::chrono::milliseconds;

constexpr int kProbes = 5;
/// At a latency of 1 ms the chip sends a packet every millisecond, usually empty.
constexpr int kPacketsPerProbe = 20;
constexpr milliseconds kPacketLimit{20};

/// Sends one packet.
/// \return whether there was a reply before the time limit
bool probe_once(FtdiTransport& transport) {
  const Packet request = FalconExchange::zero_packet();
  if (transport.send(request, kPacketLimit) != request.size()) return false;
  FalconStream stream;
  std::array<std::uint8_t, kUsbPacketSize> packet{};
  for (int i = 0; i < kPacketsPerProbe; ++i) {
    const std::size_t length = transport.receive(packet, kPacketLimit);
    if (length == 0) return false;
    if (stream.push_transfer(std::span(packet).first(length)) > 0) return true;
  }
  return false;
}

/// Starts the device and loads its firmware if necessary.
void start_device(FtdiTransport& transport, const FalconSettings& settings) {
  set_up_running_falcon(transport);
  if (probe_falcon(transport)) return;
  load_falcon_firmware(transport, read_falcon_firmware(settings.firmware));
  if (probe_falcon(transport)) return;
  throw DeviceError("falcon: does not answer after its firmware was loaded; " +
                    one_line(settings.firmware.string()) +
                    " may not be a Falcon's firmware: correct falcon.firmware in the device "
                    "settings");
}

/// \return why the firmware file cannot be used; empty if it can
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
  for (const UsbFalcon& falcon : find_usb_falcons()) {
    DeviceListing listing{"falcon", "Novint Falcon", falcon.serial, falcon.where, true, {}};
    if (!falcon.problem.empty()) listing.missing.push_back(falcon.problem);
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

bool probe_falcon(FtdiTransport& transport) {
  for (int i = 0; i < kProbes; ++i) {
    if (probe_once(transport)) return true;
  }
  return false;
}

FalconDevice::FalconDevice(std::unique_ptr<FtdiTransport> transport, const FalconSettings& settings,
                           FalconOptions options)
    : settings_(settings),
      transport_(std::move(transport)),
      options_(std::move(options)),
      exchange_(settings, link_) {
  start_device(*transport_, settings);
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
  // Bytes received since the last exchange are not a reply to this one.
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
  const FalconPace::Time deadline = monotonic_now() + kReplyLimit;
  do {
    transport_->serve(std::chrono::duration_cast<std::chrono::microseconds>(kReplyLimit));
    exchange_.publish(options_.pace->now());
    if (exchange_.is_answered() || transport_->lost()) return;
  } while (monotonic_now() < deadline);
  options_.pace->on_wait(kReplyLimit);
}

void FalconDevice::send_final_zeros() noexcept {
  transport_->stop_stream();
  try {
    for (int i = 0; i < kFinalPackets; ++i) {
      static_cast<void>(transport_->send(FalconExchange::zero_packet(), kFinalLimit));
    }
  } catch (const DeviceError&) {
    // The device was disconnected, so it cannot receive zeros.
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
          {"signs", "the signs of positions and forces on each axis"},
          {"lengths",
           "the legs' lengths and degrees per count: lengths in the sources differ by factors of "
           "1.2 to 1.5"},
          {"zero_angle",
           "the legs' angle at count 0 (32.99 or 35 degrees), which shifts the centre of the "
           "workspace"},
          {"force_scale", "the motor value for 1 N m: 6,616, 3,728 or 10,000"},
          {"homing", "whether the driver's procedures load the firmware and home the axes"},
          {"lights",
           "which bit is which light",
           "Which light was on before the grip was homed?",
           {"red", "green", "blue", "none"}},
          {"program_silent", "the motors' state after the host stops sending commands"},
          {"cable_silent", "the motors' state after the USB cable is pulled"},
          {"replies", "the latency of replies on this port"},
          {"beyond_peak", "the firmware's response to motor values beyond 4,095"},
          {"warm_motors",
           "how long the motors can exert a torque, and how warm they get (device accept "
           "--thermal)"}}};
}

}  // namespace touchtrial::device

#include "device/drivers/falcon/emulator/falcon_emulator.hpp"

#include <algorithm>
#include <iterator>

namespace touchtrial::device::falcon {
namespace {

/// The requests before a greeting, in their order.
const std::vector<ControlRequest> kBeforeGreeting = {{0x40, FtdiChip::kReset, 1, 0},
                                                     {0x40, FtdiChip::kReset, 2, 0},
                                                     {0x40, FtdiChip::kLatency, 16, 0},
                                                     {0x40, FtdiChip::kBaudDivisor, 0x4138, 0},
                                                     {0x40, FtdiChip::kData, 8, 0},
                                                     {0x40, FtdiChip::kFlowControl, 0, 0},
                                                     {0x40, FtdiChip::kModemControl, 0x200, 0},
                                                     {0x40, FtdiChip::kModemControl, 0x100, 0},
                                                     {0x40, FtdiChip::kModemControl, 0x101, 0}};

Vec3 still(Vec3 /*force_n*/) {
  return {};
}

}  // namespace

FalconEmulator::FalconEmulator(EmulatorOptions options, HandModel hand)
    : options_(std::move(options)),
      hand_(hand ? std::move(hand) : still),
      boot_loader_(options_.boot_loader) {
  if (options_.firmware_runs) running_.emplace(hand_, options_.homed);
}

UsbStatus FalconEmulator::control(const ControlRequest& request) {
  const std::scoped_lock lock(mutex_);
  if (!plugged_) return UsbStatus::gone;
  const bool had_dtr = chip_.dtr();
  if (!chip_.control(request)) {
    complain("a control request that the chip does not know");
    return UsbStatus::stall;
  }
  requests_.push_back(request);
  if (request.request == FtdiChip::kReset && request.value != 1 && runs()) running_->purge();
  if (!had_dtr && chip_.is_set_for_greeting()) reset_to_boot_loader();
  start_if_loaded();
  return UsbStatus::ok;
}

/// DTR, raised while the line is that of the boot loader, resets the Falcon's processor.
void FalconEmulator::reset_to_boot_loader() {
  if (runs()) boot_loader_ = BootLoader(options_.boot_loader);
  running_.reset();
  check_greeting_order();
}

void FalconEmulator::check_greeting_order() {
  std::vector<ControlRequest> last;
  const auto wanted = static_cast<std::ptrdiff_t>(kBeforeGreeting.size());
  const auto count = std::min<std::ptrdiff_t>(std::ssize(requests_), wanted);
  std::copy(requests_.end() - count, requests_.end(), std::back_inserter(last));
  if (last != kBeforeGreeting) complain("the set-up before the greeting is not in its order");
}

void FalconEmulator::start_if_loaded() {
  if (runs() || !chip_.is_set_for_running() || !boot_loader_.can_run()) return;
  running_.emplace(hand_, false);
}

UsbStatus FalconEmulator::bulk_out(std::span<const std::uint8_t> bytes) {
  const std::scoped_lock lock(mutex_);
  if (!plugged_) return UsbStatus::gone;
  if (runs()) {
    serve_firmware(bytes);
  } else {
    serve_boot_loader(bytes);
  }
  return UsbStatus::ok;
}

void FalconEmulator::serve_boot_loader(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > BootLoader::kMaxBlock) complain("a block of more than 62 bytes");
  if (chip_.is_set_for_greeting()) chip_.to_host(boot_loader_.greet(bytes));
  if (chip_.is_set_for_loading()) chip_.to_host(boot_loader_.load(bytes));
}

void FalconEmulator::serve_firmware(std::span<const std::uint8_t> bytes) {
  if (!chip_.is_set_for_running()) return;
  if (chip_.latency_ms() != 1) complain("the latency timer is not at 1 ms while running");
  chip_.run_out();
  const std::vector<RunningFalcon::Packet> replies = running_->receive(bytes);
  if (!replies.empty()) deliver_late();
  for (const RunningFalcon::Packet& reply : replies) deliver(reply);
}

void FalconEmulator::deliver_late() {
  for (const RunningFalcon::Packet& reply : late_) {
    chip_.to_host(reply);
    chip_.run_out();
  }
  late_.clear();
}

void FalconEmulator::deliver(const RunningFalcon::Packet& reply) {
  if (to_drop_ > 0) {
    --to_drop_;
  } else if (to_shorten_ > 0) {
    --to_shorten_;
    chip_.to_host(std::span(reply).first(kept_of_short_));
  } else if (to_delay_ > 0) {
    --to_delay_;
    late_.push_back(reply);
  } else {
    chip_.to_host(reply);
  }
}

UsbStatus FalconEmulator::bulk_in(std::size_t most, Bytes& bytes) {
  const std::scoped_lock lock(mutex_);
  if (!plugged_) return UsbStatus::gone;
  bytes = chip_.bulk_in(most);
  return UsbStatus::ok;
}

std::size_t FalconEmulator::waiting() const {
  const std::scoped_lock lock(mutex_);
  return plugged_ ? chip_.waiting() : 0;
}

bool FalconEmulator::plugged() const {
  const std::scoped_lock lock(mutex_);
  return plugged_;
}

void FalconEmulator::shorten_replies(int count, std::size_t kept) {
  const std::scoped_lock lock(mutex_);
  to_shorten_ = count;
  kept_of_short_ = std::min<std::size_t>(kept, RunningFalcon::kPacketSize - 1);
}

void FalconEmulator::send_garbage(std::span<const std::uint8_t> bytes) {
  const std::scoped_lock lock(mutex_);
  chip_.to_host(bytes);
}

void FalconEmulator::unplug() {
  const std::scoped_lock lock(mutex_);
  plugged_ = false;
  late_.clear();
  chip_.power_up();
  if (runs()) running_->cut_cable();
}

void FalconEmulator::replug(bool keeps_power) {
  const std::scoped_lock lock(mutex_);
  plugged_ = true;
  if (keeps_power) return;
  running_.reset();
  boot_loader_ = BootLoader(options_.boot_loader);
}

void FalconEmulator::set_hand(HandModel hand) {
  const std::scoped_lock lock(mutex_);
  hand_ = std::move(hand);
  if (runs()) running_->set_hand(hand_);
}

bool FalconEmulator::firmware_runs() const {
  const std::scoped_lock lock(mutex_);
  return runs();
}

int FalconEmulator::loads() const {
  const std::scoped_lock lock(mutex_);
  return boot_loader_.loads();
}

FalconEmulator::Bytes FalconEmulator::image() const {
  const std::scoped_lock lock(mutex_);
  return boot_loader_.image();
}

std::vector<ControlRequest> FalconEmulator::requests() const {
  const std::scoped_lock lock(mutex_);
  return requests_;
}

std::vector<std::string> FalconEmulator::complaints() const {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> all = complaints_;
  if (runs()) {
    all.insert(all.end(), running_->complaints().begin(), running_->complaints().end());
  }
  return all;
}

void FalconEmulator::complain(const std::string& what) {
  if (std::find(complaints_.begin(), complaints_.end(), what) == complaints_.end()) {
    complaints_.push_back(what);
  }
}

}  // namespace touchtrial::device::falcon

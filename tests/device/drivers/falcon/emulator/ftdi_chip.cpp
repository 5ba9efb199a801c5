#include "device/drivers/falcon/emulator/ftdi_chip.hpp"

#include <algorithm>

namespace touchtrial::device::falcon {

bool FtdiChip::control(const ControlRequest& r) {
  if (r.type != 0x40 || r.index != 0) return false;
  switch (r.request) {
    case kReset:
      if (r.value > 2) return false;
      if (r.value != 2) take(to_host_.size());
      return true;
    case kModemControl:
      set_modem_lines(r.value);
      return true;
    case kFlowControl:
      flow_ = r.value != 0;
      return true;
    case kBaudDivisor:
      divisor_ = r.value;
      return true;
    case kData:
      data_ = r.value;
      return true;
    case kLatency:
      latency_ms_ = r.value;
      return r.value >= 1 && r.value <= 255;
    default:
      return false;
  }
}

void FtdiChip::set_modem_lines(std::uint16_t value) {
  // The high byte selects the lines, the low one gives their new states.
  if ((value & 0x100U) != 0) dtr_ = (value & 0x1U) != 0;
  if ((value & 0x200U) != 0) rts_ = (value & 0x2U) != 0;
}

bool FtdiChip::is_set_for_greeting() const {
  return is_plain() && divisor_ == kDivisor9600 && dtr_ && latency_ms_ == 16;
}

bool FtdiChip::is_set_for_loading() const {
  return is_plain() && divisor_ == kDivisor140k && !dtr_ && latency_ms_ == 16;
}

bool FtdiChip::is_set_for_running() const {
  return divisor_ == kDivisorRunning;
}

void FtdiChip::to_host(std::span<const std::uint8_t> bytes) {
  const std::size_t fits = std::min(bytes.size(), kBufferSize - to_host_.size());
  to_host_.insert(to_host_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(fits));
}

std::size_t FtdiChip::next_packet(std::size_t most) const {
  const std::size_t end = packet_ends_.empty() ? to_host_.size() : packet_ends_.front();
  return std::min({most, end, to_host_.size()});
}

void FtdiChip::take(std::size_t count) {
  to_host_.erase(to_host_.begin(), to_host_.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t& end : packet_ends_) end -= std::min(end, count);
  while (!packet_ends_.empty() && packet_ends_.front() == 0) packet_ends_.pop_front();
}

std::vector<std::uint8_t> FtdiChip::bulk_in(std::size_t most) {
  constexpr std::size_t kStatus = 2;
  constexpr std::size_t kPayload = 62;
  std::vector<std::uint8_t> transfer;
  while (transfer.size() + kStatus <= most) {
    const std::size_t size = next_packet(std::min(most - transfer.size() - kStatus, kPayload));
    transfer.insert(transfer.end(), {0x01, 0x60});
    transfer.insert(transfer.end(), to_host_.begin(),
                    to_host_.begin() + static_cast<std::ptrdiff_t>(size));
    take(size);
    if (size < kPayload || to_host_.empty()) break;
  }
  return transfer;
}

}  // namespace touchtrial::device::falcon

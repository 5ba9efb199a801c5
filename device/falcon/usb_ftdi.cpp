#include "device/falcon/usb_ftdi.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace touchtrial::device::falcon {
namespace {

constexpr unsigned char kOutEndpoint = 0x02;
constexpr unsigned char kInEndpoint = 0x81;
constexpr std::uint8_t kVendorRequest = 0x40;
constexpr unsigned kControlTimeoutMs = 1000;

/// Failures of transfers in a row that a bad cable may cause; after more the link counts as lost.
constexpr int kMostFailures = 20;
/// For cancelled transfers to come back.
constexpr std::chrono::seconds kPatience{2};

/// What libusb never gave back stays its own: freed, it would be written to.
void leave_to_libusb(UsbTransfer& transfer) {
  static std::vector<UsbTransfer>& left = *new std::vector<UsbTransfer>;
  left.push_back(std::move(transfer));
}

}  // namespace

UsbFtdi::UsbFtdi(UsbContext context, UsbHandle handle)
    : context_(std::move(context)),
      handle_(std::move(handle)),
      where_(place_of(libusb_get_device(handle_.get()))),
      serial_(serial_of(handle_.get())),
      claim_(handle_.get(), where_),
      read_(make_usb_transfer()),
      send_(make_usb_transfer()) {}

UsbFtdi::~UsbFtdi() {
  stop_stream();
}

void UsbFtdi::control(FtdiRequest request, std::uint16_t value) {
  const int result =
      libusb_control_transfer(handle_.get(), kVendorRequest, static_cast<std::uint8_t>(request),
                              value, 0, nullptr, 0, kControlTimeoutMs);
  if (result < 0) throw DeviceError("falcon at " + where_ + ": " + usb_remedy(result));
}

std::size_t UsbFtdi::transfer(unsigned char endpoint, std::uint8_t* bytes, int count,
                              std::chrono::milliseconds limit) {
  int done = 0;
  // A limit of 0 would be none.
  const auto limit_ms = static_cast<unsigned>(std::max<std::int64_t>(limit.count(), 1));
  const int result = libusb_bulk_transfer(handle_.get(), endpoint, bytes, count, &done, limit_ms);
  if (result != 0 && result != LIBUSB_ERROR_TIMEOUT) {
    throw DeviceError("falcon at " + where_ + ": " + usb_remedy(result));
  }
  return static_cast<std::size_t>(done);
}

std::size_t UsbFtdi::send(std::span<const std::uint8_t> bytes, std::chrono::milliseconds limit) {
  const std::size_t count = std::min(bytes.size(), out_.size());
  std::copy_n(bytes.begin(), count, out_.begin());
  return transfer(kOutEndpoint, out_.data(), static_cast<int>(count), limit);
}

std::size_t UsbFtdi::receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                             std::chrono::milliseconds limit) {
  return transfer(kInEndpoint, packet.data(), static_cast<int>(packet.size()), limit);
}

void UsbFtdi::start_stream(FtdiStreamSink& sink) {
  sink_ = &sink;
  failures_ = 0;
  queue_read();
  if (lost_) throw DeviceError("falcon at " + where_ + ": " + usb_remedy(LIBUSB_ERROR_NO_DEVICE));
}

void UsbFtdi::stop_stream() noexcept {
  sink_ = nullptr;
  if (reading_) libusb_cancel_transfer(read_.get());
  if (sending_) libusb_cancel_transfer(send_.get());
  // A transfer belongs to libusb until its callback has run, also on a device that is gone.
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  while ((reading_ || sending_) && deaf_ <= kMostFailures &&
         std::chrono::steady_clock::now() < give_up) {
    serve(std::chrono::milliseconds(100));
  }
  if (!reading_ && !sending_) return;
  lost_ = true;
  if (std::exchange(reading_, false)) leave_to_libusb(read_);
  if (std::exchange(sending_, false)) leave_to_libusb(send_);
}

void UsbFtdi::queue_read() noexcept {
  libusb_fill_bulk_transfer(read_.get(), handle_.get(), kInEndpoint, in_.data(),
                            static_cast<int>(in_.size()), &on_read, this, 0);
  reading_ = libusb_submit_transfer(read_.get()) == 0;
  if (!reading_) lost_ = true;
}

bool UsbFtdi::post(std::span<const std::uint8_t> bytes) noexcept {
  if (sending_ || lost_ || bytes.size() > out_.size()) return false;
  std::copy(bytes.begin(), bytes.end(), out_.begin());
  libusb_fill_bulk_transfer(send_.get(), handle_.get(), kOutEndpoint, out_.data(),
                            static_cast<int>(bytes.size()), &on_sent, this, 0);
  const int error = libusb_submit_transfer(send_.get());
  sending_ = error == 0;
  if (error == LIBUSB_ERROR_NO_DEVICE) lost_ = true;
  return sending_;
}

void UsbFtdi::serve(std::chrono::microseconds at_most) noexcept {
  timeval limit{};
  limit.tv_sec = at_most.count() / 1'000'000;
  limit.tv_usec = at_most.count() % 1'000'000;
  const int error = libusb_handle_events_timeout_completed(context_.get(), &limit, nullptr);
  if (error == LIBUSB_ERROR_INTERRUPTED) return;
  deaf_ = error == 0 ? 0 : deaf_ + 1;
  if (deaf_ > kMostFailures) lost_ = true;
}

void UsbFtdi::note(libusb_transfer_status status) noexcept {
  failures_ = status == LIBUSB_TRANSFER_COMPLETED ? 0 : failures_ + 1;
  if (status == LIBUSB_TRANSFER_NO_DEVICE || failures_ > kMostFailures) lost_ = true;
}

void LIBUSB_CALL UsbFtdi::on_read(libusb_transfer* transfer) {
  auto& self = *static_cast<UsbFtdi*>(transfer->user_data);
  self.reading_ = false;
  if (self.sink_ == nullptr) return;
  self.note(transfer->status);
  const auto length = static_cast<std::size_t>(transfer->actual_length);
  if (transfer->status == LIBUSB_TRANSFER_COMPLETED) {
    self.sink_->receive(std::span(self.in_).first(length));
  }
  if (!self.lost_) self.queue_read();
}

void LIBUSB_CALL UsbFtdi::on_sent(libusb_transfer* transfer) {
  auto& self = *static_cast<UsbFtdi*>(transfer->user_data);
  self.sending_ = false;
  if (self.sink_ != nullptr) self.note(transfer->status);
}

}  // namespace touchtrial::device::falcon

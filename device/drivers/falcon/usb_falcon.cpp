#include "device/drivers/falcon/usb_falcon.hpp"

#include "core/errors.hpp"
#include "core/text.hpp"
#include "device/drivers/falcon/usb_handles.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::device::falcon {
namespace {

constexpr unsigned char kOutEndpoint = 0x02;
constexpr unsigned char kInEndpoint = 0x81;
constexpr std::uint8_t kVendorRequest = 0x40;
constexpr unsigned kControlTimeoutMs = 1000;

/// A bad cable may cause this many failed transfers in a row; after more the link is lost.
constexpr int kMaxFailures = 20;
/// The time limit for cancelled transfers.
constexpr std::chrono::seconds kTimeout{2};

/// Leaks a transfer that libusb did not return, because it might still write to the memory.
void leave_to_libusb(UsbTransfer& transfer) {
  static std::vector<UsbTransfer>& left = *new std::vector<UsbTransfer>;
  left.push_back(std::move(transfer));
}

/// The FTDI chip of a Falcon, by libusb.
class UsbFtdi final : public FtdiTransport {
 public:
  /// Takes over an open device and claims it.
  /// \throws DeviceError if another program has it
  UsbFtdi(UsbContext context, UsbHandle handle);
  ~UsbFtdi() override;

  [[nodiscard]] std::string serial() const override { return serial_; }
  void control(FtdiRequest request, std::uint16_t value) override;
  [[nodiscard]] std::size_t send(std::span<const std::uint8_t> bytes,
                                 std::chrono::milliseconds limit) override;
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                                    std::chrono::milliseconds limit) override;

  void start_stream(FtdiStreamSink& sink) override;
  void stop_stream() noexcept override;
  [[nodiscard]] bool post(std::span<const std::uint8_t> bytes) noexcept override;
  void serve(std::chrono::microseconds max_wait) noexcept override;
  [[nodiscard]] bool lost() const noexcept override { return lost_; }

 private:
  static void LIBUSB_CALL on_read(libusb_transfer* transfer);
  static void LIBUSB_CALL on_sent(libusb_transfer* transfer);
  [[nodiscard]] std::size_t transfer(unsigned char endpoint, std::uint8_t* bytes, int count,
                                     std::chrono::milliseconds limit);
  void queue_read() noexcept;
  [[nodiscard]] bool submit_next() noexcept;
  /// Counts failures in a row. The device is lost after too many, or if it was unplugged.
  void note(libusb_transfer_status status) noexcept;
  [[nodiscard]] DeviceError failure(int error) const;

  // Declared in the order of acquisition, for release in reverse.
  UsbContext context_;
  UsbHandle handle_;
  std::string where_;
  std::string serial_;
  UsbClaim claim_;
  UsbTransfer read_;
  UsbTransfer send_;
  std::array<std::uint8_t, kUsbPacketSize> in_{};
  std::array<std::uint8_t, kUsbPacketSize> out_{};
  std::array<std::uint8_t, kUsbPacketSize> next_{};  ///< to send once `out_` has completed
  std::size_t next_size_ = 0;
  FtdiStreamSink* sink_ = nullptr;  ///< null: no stream, so no further read is queued
  bool reading_ = false;
  bool sending_ = false;
  bool halted_ = false;  ///< the device refuses packets until its endpoint is cleared
  int stuck_ = 0;        ///< packets in a row that the device did not take in time
  int failures_ = 0;
  int failed_polls_ = 0;  ///< calls in a row in which libusb failed to handle events
  bool lost_ = false;     ///< for the stream; a final packet may still be tried
  bool dead_ = false;     ///< the bus did not return a transfer, so another would wait for ever
};

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
  if (result < 0) throw failure(result);
}

DeviceError UsbFtdi::failure(int error) const {
  return DeviceError("falcon at " + where_ + ": " + usb_remedy(error));
}

std::size_t UsbFtdi::transfer(unsigned char endpoint, std::uint8_t* bytes, int count,
                              std::chrono::milliseconds limit) {
  if (dead_) throw failure(LIBUSB_ERROR_IO);
  int done = 0;
  // libusb treats a limit of 0 as no limit.
  const auto limit_ms = static_cast<unsigned>(std::max<std::int64_t>(limit.count(), 1));
  int result = libusb_bulk_transfer(handle_.get(), endpoint, bytes, count, &done, limit_ms);
  if (result == LIBUSB_ERROR_PIPE && libusb_clear_halt(handle_.get(), endpoint) == 0) {
    result = libusb_bulk_transfer(handle_.get(), endpoint, bytes, count, &done, limit_ms);
  }
  if (result != 0 && result != LIBUSB_ERROR_TIMEOUT) throw failure(result);
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
  failures_ = stuck_ = 0;
  queue_read();
  if (lost_) throw failure(LIBUSB_ERROR_NO_DEVICE);
}

void UsbFtdi::stop_stream() noexcept {
  sink_ = nullptr;
  next_size_ = 0;
  if (reading_) libusb_cancel_transfer(read_.get());
  if (sending_) libusb_cancel_transfer(send_.get());
  // A transfer belongs to libusb until its callback has run, even if the device was disconnected.
  const auto give_up = std::chrono::steady_clock::now() + kTimeout;
  while ((reading_ || sending_) && failed_polls_ <= kMaxFailures &&
         std::chrono::steady_clock::now() < give_up) {
    serve(std::chrono::milliseconds(100));
  }
  if (!reading_ && !sending_) return;
  lost_ = dead_ = true;
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
  if (lost_ || bytes.size() > next_.size()) return false;
  std::copy(bytes.begin(), bytes.end(), next_.begin());
  next_size_ = bytes.size();
  if (!sending_) return submit_next();
  if (++stuck_ >= kMaxStuck) lost_ = true;
  // It completes as cancelled or sent; then the next one is submitted.
  libusb_cancel_transfer(send_.get());
  return !lost_;
}

bool UsbFtdi::submit_next() noexcept {
  if (halted_) halted_ = libusb_clear_halt(handle_.get(), kOutEndpoint) != 0;
  const std::size_t size = std::exchange(next_size_, 0);
  std::copy_n(next_.begin(), size, out_.begin());
  libusb_fill_bulk_transfer(send_.get(), handle_.get(), kOutEndpoint, out_.data(),
                            static_cast<int>(size), &on_sent, this, 0);
  const int error = libusb_submit_transfer(send_.get());
  sending_ = error == 0;
  if (error == LIBUSB_ERROR_NO_DEVICE) lost_ = true;
  return sending_;
}

void UsbFtdi::serve(std::chrono::microseconds max_wait) noexcept {
  timeval limit{};
  limit.tv_sec = max_wait.count() / 1'000'000;
  limit.tv_usec = max_wait.count() % 1'000'000;
  const int error = libusb_handle_events_timeout_completed(context_.get(), &limit, nullptr);
  if (error == LIBUSB_ERROR_INTERRUPTED) return;
  failed_polls_ = error == 0 ? 0 : failed_polls_ + 1;
  if (failed_polls_ > kMaxFailures) lost_ = true;
}

void UsbFtdi::note(libusb_transfer_status status) noexcept {
  failures_ = status == LIBUSB_TRANSFER_COMPLETED ? 0 : failures_ + 1;
  if (status == LIBUSB_TRANSFER_NO_DEVICE || failures_ > kMaxFailures) lost_ = true;
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
  if (self.sink_ == nullptr) return;
  const bool cancelled = transfer->status == LIBUSB_TRANSFER_CANCELLED;
  if (!cancelled) self.note(transfer->status);
  // One that was cancelled too late was also sent.
  const bool whole = transfer->actual_length == transfer->length;
  if (whole && (cancelled || transfer->status == LIBUSB_TRANSFER_COMPLETED)) {
    self.stuck_ = 0;
    self.sink_->sent();
  }
  // Cleared before the next packet; libusb forbids waiting in its callbacks.
  self.halted_ = transfer->status == LIBUSB_TRANSFER_STALL;
  const bool next = self.next_size_ > 0 && !self.lost_ && !self.halted_;
  if (next) static_cast<void>(self.submit_next());
}

/// Checks whether the device can be claimed, by claiming it briefly.
void fill_in(UsbFalcon& falcon, libusb_device* device) {
  try {
    const UsbHandle handle = open_usb_device(device);
    falcon.serial = serial_of(handle.get());
    if (libusb_kernel_driver_active(handle.get(), 0) != 1) {
      const UsbClaim claim(handle.get(), falcon.where);
    }
  } catch (const DeviceError& error) {
    falcon.trouble = error.what();
  }
}

/// \return the handle of the only Falcon
UsbHandle open_only(const std::vector<UsbDevice>& falcons) {
  if (falcons.size() == 1) return open_usb_device(falcons.front().get());
  std::vector<std::string> places;
  for (const UsbDevice& device : falcons) places.push_back(place_of(device.get()));
  throw DeviceError("falcon: there are several (" + listed(places) +
                    "); name the serial number of one in the device settings, falcon.serial");
}

/// Skips devices that do not open; if no other has the serial number, the error gives the last
/// reason.
/// \return the handle of the Falcon with this serial number
UsbHandle open_by_serial(const std::vector<UsbDevice>& falcons, const std::string& serial) {
  std::vector<std::string> seen;
  std::string trouble;
  for (const UsbDevice& device : falcons) {
    try {
      UsbHandle handle = open_usb_device(device.get());
      const std::string own = serial_of(handle.get());
      if (own == serial) return handle;
      seen.push_back(own.empty() ? "one without a serial number" : own);
    } catch (const DeviceError& error) {
      trouble = error.what();
    }
  }
  if (!trouble.empty()) throw DeviceError(trouble);
  throw DeviceError(one_line("falcon: none has the serial number " + serial + ", but there is " +
                             listed(seen) + "; correct falcon.serial in the device settings"));
}

}  // namespace

std::vector<UsbFalcon> find_usb_falcons() {
  const UsbContext context = make_usb_context();
  std::vector<UsbFalcon> found;
  for (const UsbDevice& device : falcons_on_bus(context.get())) {
    found.push_back({place_of(device.get()), {}, {}});
    fill_in(found.back(), device.get());
  }
  return found;
}

std::unique_ptr<FtdiTransport> open_usb_falcon(const std::string& serial) {
  UsbContext context = make_usb_context();
  const std::vector<UsbDevice> falcons = falcons_on_bus(context.get());
  if (falcons.empty()) {
    throw DeviceError(
        "falcon: none is plugged in (USB 0403:cb48); plug it in and switch its power on");
  }
  UsbHandle handle = serial.empty() ? open_only(falcons) : open_by_serial(falcons, serial);
  return std::make_unique<UsbFtdi>(std::move(context), std::move(handle));
}

}  // namespace touchtrial::device::falcon

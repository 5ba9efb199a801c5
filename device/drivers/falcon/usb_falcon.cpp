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

/// A bad cable may cause this many consecutive failed transfers; after more the link is lost.
constexpr int kMaxFailures = 20;
/// How long `stop_stream` waits for cancelled transfers.
constexpr std::chrono::seconds kTimeout{2};

/// Leaks a transfer that libusb did not return, because libusb might still write to its memory.
void leak_transfer(UsbTransfer& transfer) {
  static std::vector<UsbTransfer>& leaked = *new std::vector<UsbTransfer>;
  leaked.push_back(std::move(transfer));
}

/// The FTDI chip of a Falcon, accessed through libusb.
class UsbFtdi final : public FtdiTransport {
 public:
  /// Takes over an open device and claims it.
  /// \throws DeviceError if another program uses it
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
  [[nodiscard]] bool lost() const noexcept override { return is_lost_; }

 private:
  static void LIBUSB_CALL on_read(libusb_transfer* transfer);
  static void LIBUSB_CALL on_sent(libusb_transfer* transfer);
  [[nodiscard]] std::size_t transfer(unsigned char endpoint, std::uint8_t* bytes, int count,
                                     std::chrono::milliseconds limit);
  void queue_read() noexcept;
  [[nodiscard]] bool submit_next() noexcept;
  /// Counts consecutive failures. The device is lost after too many, or if it was unplugged.
  void count_failure(libusb_transfer_status status) noexcept;
  [[nodiscard]] DeviceError failure(int error) const;

  // Declared in the order of acquisition, because members are destroyed in reverse.
  UsbContext context_;
  UsbHandle handle_;
  std::string where_;
  std::string serial_;
  UsbClaim claim_;
  UsbTransfer read_transfer_;
  UsbTransfer send_transfer_;
  std::array<std::uint8_t, kUsbPacketSize> in_buffer_{};
  std::array<std::uint8_t, kUsbPacketSize> out_buffer_{};
  /// Sent once `out_buffer_` has completed.
  std::array<std::uint8_t, kUsbPacketSize> next_packet_{};
  std::size_t next_size_ = 0;
  FtdiStreamSink* sink_ = nullptr;  ///< null: no stream, so no further read is queued
  bool is_reading_ = false;
  bool is_sending_ = false;
  bool is_endpoint_halted_ = false;  ///< the device refuses packets until its endpoint is cleared
  int stuck_packets_ = 0;            ///< consecutive packets that the device did not accept in time
  int failures_ = 0;
  int failed_polls_ = 0;         ///< consecutive calls in which libusb failed to handle events
  bool is_lost_ = false;         ///< ends the stream; single transfers may still be tried
  bool has_bus_failed_ = false;  ///< the bus did not return a transfer, so another one would hang
};

UsbFtdi::UsbFtdi(UsbContext context, UsbHandle handle)
    : context_(std::move(context)),
      handle_(std::move(handle)),
      where_(usb_location_of(libusb_get_device(handle_.get()))),
      serial_(serial_of(handle_.get())),
      claim_(handle_.get(), where_),
      read_transfer_(make_usb_transfer()),
      send_transfer_(make_usb_transfer()) {}

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
  if (has_bus_failed_) throw failure(LIBUSB_ERROR_IO);
  int transferred = 0;
  // libusb treats a limit of 0 as no limit.
  const auto limit_ms = static_cast<unsigned>(std::max<std::int64_t>(limit.count(), 1));
  int result = libusb_bulk_transfer(handle_.get(), endpoint, bytes, count, &transferred, limit_ms);
  if (result == LIBUSB_ERROR_PIPE && libusb_clear_halt(handle_.get(), endpoint) == 0) {
    result = libusb_bulk_transfer(handle_.get(), endpoint, bytes, count, &transferred, limit_ms);
  }
  if (result != 0 && result != LIBUSB_ERROR_TIMEOUT) throw failure(result);
  return static_cast<std::size_t>(transferred);
}

std::size_t UsbFtdi::send(std::span<const std::uint8_t> bytes, std::chrono::milliseconds limit) {
  const std::size_t count = std::min(bytes.size(), out_buffer_.size());
  std::copy_n(bytes.begin(), count, out_buffer_.begin());
  return transfer(kOutEndpoint, out_buffer_.data(), static_cast<int>(count), limit);
}

std::size_t UsbFtdi::receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                             std::chrono::milliseconds limit) {
  return transfer(kInEndpoint, packet.data(), static_cast<int>(packet.size()), limit);
}

void UsbFtdi::start_stream(FtdiStreamSink& sink) {
  sink_ = &sink;
  failures_ = stuck_packets_ = 0;
  queue_read();
  if (is_lost_) throw failure(LIBUSB_ERROR_NO_DEVICE);
}

void UsbFtdi::stop_stream() noexcept {
  sink_ = nullptr;
  next_size_ = 0;
  if (is_reading_) libusb_cancel_transfer(read_transfer_.get());
  if (is_sending_) libusb_cancel_transfer(send_transfer_.get());
  // A transfer belongs to libusb until its callback has run, even if the device was disconnected.
  const auto deadline = std::chrono::steady_clock::now() + kTimeout;
  while ((is_reading_ || is_sending_) && failed_polls_ <= kMaxFailures &&
         std::chrono::steady_clock::now() < deadline) {
    serve(std::chrono::milliseconds(100));
  }
  if (!is_reading_ && !is_sending_) return;
  is_lost_ = has_bus_failed_ = true;
  if (std::exchange(is_reading_, false)) leak_transfer(read_transfer_);
  if (std::exchange(is_sending_, false)) leak_transfer(send_transfer_);
}

void UsbFtdi::queue_read() noexcept {
  libusb_fill_bulk_transfer(read_transfer_.get(), handle_.get(), kInEndpoint, in_buffer_.data(),
                            static_cast<int>(in_buffer_.size()), &on_read, this, 0);
  is_reading_ = libusb_submit_transfer(read_transfer_.get()) == 0;
  if (!is_reading_) is_lost_ = true;
}

bool UsbFtdi::post(std::span<const std::uint8_t> bytes) noexcept {
  if (is_lost_ || bytes.size() > next_packet_.size()) return false;
  std::copy(bytes.begin(), bytes.end(), next_packet_.begin());
  next_size_ = bytes.size();
  if (!is_sending_) return submit_next();
  if (++stuck_packets_ >= kMaxStuck) is_lost_ = true;
  // It completes as cancelled or sent; then `on_sent` submits the next packet.
  libusb_cancel_transfer(send_transfer_.get());
  return !is_lost_;
}

bool UsbFtdi::submit_next() noexcept {
  if (is_endpoint_halted_)
    is_endpoint_halted_ = libusb_clear_halt(handle_.get(), kOutEndpoint) != 0;
  const std::size_t size = std::exchange(next_size_, 0);
  std::copy_n(next_packet_.begin(), size, out_buffer_.begin());
  libusb_fill_bulk_transfer(send_transfer_.get(), handle_.get(), kOutEndpoint, out_buffer_.data(),
                            static_cast<int>(size), &on_sent, this, 0);
  const int error = libusb_submit_transfer(send_transfer_.get());
  is_sending_ = error == 0;
  if (error == LIBUSB_ERROR_NO_DEVICE) is_lost_ = true;
  return is_sending_;
}

void UsbFtdi::serve(std::chrono::microseconds max_wait) noexcept {
  timeval limit{};
  limit.tv_sec = max_wait.count() / 1'000'000;
  limit.tv_usec = max_wait.count() % 1'000'000;
  const int error = libusb_handle_events_timeout_completed(context_.get(), &limit, nullptr);
  if (error == LIBUSB_ERROR_INTERRUPTED) return;
  failed_polls_ = error == 0 ? 0 : failed_polls_ + 1;
  if (failed_polls_ > kMaxFailures) is_lost_ = true;
}

void UsbFtdi::count_failure(libusb_transfer_status status) noexcept {
  failures_ = status == LIBUSB_TRANSFER_COMPLETED ? 0 : failures_ + 1;
  if (status == LIBUSB_TRANSFER_NO_DEVICE || failures_ > kMaxFailures) is_lost_ = true;
}

void LIBUSB_CALL UsbFtdi::on_read(libusb_transfer* transfer) {
  auto& self = *static_cast<UsbFtdi*>(transfer->user_data);
  self.is_reading_ = false;
  if (self.sink_ == nullptr) return;
  self.count_failure(transfer->status);
  const auto length = static_cast<std::size_t>(transfer->actual_length);
  if (transfer->status == LIBUSB_TRANSFER_COMPLETED) {
    self.sink_->receive(std::span(self.in_buffer_).first(length));
  }
  if (!self.is_lost_) self.queue_read();
}

void LIBUSB_CALL UsbFtdi::on_sent(libusb_transfer* transfer) {
  auto& self = *static_cast<UsbFtdi*>(transfer->user_data);
  self.is_sending_ = false;
  if (self.sink_ == nullptr) return;
  const bool was_cancelled = transfer->status == LIBUSB_TRANSFER_CANCELLED;
  if (!was_cancelled) self.count_failure(transfer->status);
  // A packet that was cancelled too late was sent as well.
  const bool is_complete = transfer->actual_length == transfer->length;
  if (is_complete && (was_cancelled || transfer->status == LIBUSB_TRANSFER_COMPLETED)) {
    self.stuck_packets_ = 0;
    self.sink_->sent();
  }
  // The halt is cleared before the next packet, because libusb forbids blocking in callbacks.
  self.is_endpoint_halted_ = transfer->status == LIBUSB_TRANSFER_STALL;
  const bool sends_next = self.next_size_ > 0 && !self.is_lost_ && !self.is_endpoint_halted_;
  if (sends_next) static_cast<void>(self.submit_next());
}

/// Adds the serial number, and the problem if the device cannot be opened and claimed.
void add_access(UsbFalcon& falcon, libusb_device* device) {
  try {
    const UsbHandle handle = open_usb_device(device);
    falcon.serial = serial_of(handle.get());
    if (libusb_kernel_driver_active(handle.get(), 0) != 1) {
      const UsbClaim claim(handle.get(), falcon.where);
    }
  } catch (const DeviceError& error) {
    falcon.problem = error.what();
  }
}

/// \return the handle of the only Falcon
UsbHandle open_single(const std::vector<UsbDevice>& falcons) {
  if (falcons.size() == 1) return open_usb_device(falcons.front().get());
  std::vector<std::string> locations;
  for (const UsbDevice& device : falcons) locations.push_back(usb_location_of(device.get()));
  throw DeviceError("falcon: there are several (" + listed(locations) +
                    "); name the serial number of one in the device settings, falcon.serial");
}

/// Skips devices that cannot be opened.
/// \return the handle of the Falcon with this serial number
/// \throws DeviceError if none has it; with the last reason if one could not be opened
UsbHandle open_by_serial(const std::vector<UsbDevice>& falcons, const std::string& serial) {
  std::vector<std::string> serials;
  std::string problem;
  for (const UsbDevice& device : falcons) {
    try {
      UsbHandle handle = open_usb_device(device.get());
      const std::string handle_serial = serial_of(handle.get());
      if (handle_serial == serial) return handle;
      serials.push_back(handle_serial.empty() ? "one without a serial number" : handle_serial);
    } catch (const DeviceError& error) {
      problem = error.what();
    }
  }
  if (!problem.empty()) throw DeviceError(problem);
  throw DeviceError(one_line("falcon: none has the serial number " + serial + "; found " +
                             listed(serials) + "; correct falcon.serial in the device settings"));
}

}  // namespace

std::vector<UsbFalcon> find_usb_falcons() {
  const UsbContext context = make_usb_context();
  std::vector<UsbFalcon> falcons;
  for (const UsbDevice& device : falcons_on_bus(context.get())) {
    falcons.push_back({usb_location_of(device.get()), {}, {}});
    add_access(falcons.back(), device.get());
  }
  return falcons;
}

std::unique_ptr<FtdiTransport> open_usb_falcon(const std::string& serial) {
  UsbContext context = make_usb_context();
  const std::vector<UsbDevice> falcons = falcons_on_bus(context.get());
  if (falcons.empty()) {
    throw DeviceError(
        "falcon: none is plugged in (USB 0403:cb48); plug it in and switch its power on");
  }
  UsbHandle handle = serial.empty() ? open_single(falcons) : open_by_serial(falcons, serial);
  return std::make_unique<UsbFtdi>(std::move(context), std::move(handle));
}

}  // namespace touchtrial::device::falcon

#include "app/windows/glfw_support.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/hash.hpp"
#include "core/strict_json.hpp"
#include "core/units.hpp"
#include "device/device_settings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <system_error>
#include <vector>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

/// The visible area of the window on the monitor, window units squared.
int overlap(GLFWwindow* window, GLFWmonitor* monitor) {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  int monitor_x = 0;
  int monitor_y = 0;
  glfwGetMonitorPos(monitor, &monitor_x, &monitor_y);
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  if (mode == nullptr) return 0;
  const int overlap_width = std::min(x + width, monitor_x + mode->width) - std::max(x, monitor_x);
  const int overlap_height =
      std::min(y + height, monitor_y + mode->height) - std::max(y, monitor_y);
  return std::max(overlap_width, 0) * std::max(overlap_height, 0);
}

GLFWmonitor* monitor_of(GLFWwindow* window) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  GLFWmonitor* best = glfwGetPrimaryMonitor();
  int max_visible_area = 0;
  for (int i = 0; i < count; ++i) {
    const int visible_area = overlap(window, monitors[i]);
    if (visible_area > max_visible_area) best = monitors[i];
    max_visible_area = std::max(max_visible_area, visible_area);
  }
  return best;
}

/// If the system scales windows, a window unit already covers several pixels.
float density_of(GLFWwindow* window) {
  float content = 1.0F;
  glfwGetWindowContentScale(window, &content, nullptr);
  int units = 0;
  int pixels = 0;
  glfwGetWindowSize(window, &units, nullptr);
  glfwGetFramebufferSize(window, &pixels, nullptr);
  if (units <= 0 || pixels <= 0) return 1.0F;
  const float pixels_per_unit = static_cast<float>(pixels) / static_cast<float>(units);
  return std::clamp(content / pixels_per_unit, 1.0F, 4.0F);
}

constexpr std::size_t kMaxScreens = 1000;
// Filled on the main thread when GLFW starts.
std::map<std::string, double> measured_screens;  ///< mm_per_unit by ScreenScale::monitor
std::map<std::string, std::string> edids;        ///< EDID hashes by the monitor's name

/// The first digits of the hash of the monitor's EDID; empty if the system does not provide it.
/// Linux lists it by connector, whose name the windowing system may shorten: "HDMI-1" for
/// "HDMI-A-1".
std::string edid_of(const std::string& name) {
  constexpr std::size_t kDigits = 8;
  std::string full_name = name;
  if (const std::size_t at = full_name.find("HDMI-"); at != std::string::npos) {
    full_name.insert(at + 5, "A-");
  }
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator("/sys/class/drm", unreadable)) {
    const std::string connector = entry.path().filename().string();
    if (!connector.ends_with("-" + name) && !connector.ends_with("-" + full_name)) continue;
    try {
      const Bytes edid = read_file(entry.path() / "edid");
      if (!edid.empty()) return to_hex(sha256(edid)).substr(0, kDigits);
    } catch (const FileError&) {
      continue;
    }
  }
  return "";
}

std::string identity_of(GLFWmonitor* monitor, const GLFWvidmode& mode) {
  int width_mm = 0;
  int height_mm = 0;
  glfwGetMonitorPhysicalSize(monitor, &width_mm, &height_mm);
  const char* const monitor_name = glfwGetMonitorName(monitor);
  const std::string name = one_line(monitor_name == nullptr ? "monitor" : monitor_name);
  const auto [entry, is_new] = edids.try_emplace(name);
  if (is_new) entry->second = edid_of(name);
  const std::string& edid = entry->second;
  return fmt::format("{}, {} x {}, {} x {} mm{}", name, mode.width, mode.height, width_mm,
                     height_mm, edid.empty() ? "" : ", EDID " + edid);
}

/// \throws StudyError, or FileError, with the remedy
std::map<std::string, double> read_measured_screens(const std::filesystem::path& file) {
  std::map<std::string, double> screens;
  if (file.empty() || !path_exists(file)) return screens;
  constexpr std::uintmax_t kMaxFileBytes = 1U << 20U;
  const Bytes content = read_file(file, kMaxFileBytes);
  const JsonObject root = parse_strict_json(text_of(content), file.string()).object({"screens"});
  for (const JsonValue& item : root.at("screens").items(0, kMaxScreens)) {
    const JsonObject screen = item.object({"monitor", "mm_per_unit"});
    screens[screen.at("monitor").text()] =
        screen.at("mm_per_unit").number({kMmPerInch / 400.0, kMmPerInch / 40.0});
  }
  return screens;
}

}  // namespace

std::filesystem::path measured_screens_path() {
  std::filesystem::path file = device::default_device_settings_path();
  if (!file.empty()) file.replace_filename("screens.json");
  return file;
}

void save_measured_screen(const std::string& monitor, double mm_per_unit) {
  measured_screens[monitor] = mm_per_unit;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [name, scale] : measured_screens) {
    list.push_back({{"monitor", name}, {"mm_per_unit", scale}});
  }
  const std::filesystem::path file = measured_screens_path();
  make_folder(file.parent_path());
  replace_file(file, nlohmann::ordered_json{{"screens", list}}.dump(2) + "\n");
}

GlfwLibrary::GlfwLibrary() {
  edids.clear();
  try {
    measured_screens = read_measured_screens(measured_screens_path());
  } catch (const Error& error) {
    measured_screens.clear();
    spdlog::warn(
        "{}; measured screen sizes are ignored; measure again with `touchtrial screen calibrate`",
        error.what());
  }
#ifdef GLFW_PLATFORM
  // GLFW 3.4 and later also support Wayland, where windows cannot be positioned.
  glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (glfwInit() != GLFW_TRUE) {
    refuse_window("run in a graphical session (DISPLAY), or under xvfb-run");
  }
}

GlfwLibrary::~GlfwLibrary() {
  glfwTerminate();
}

void refuse_window(const std::string& remedy) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw DeviceError(one_line(
      "window: " + std::string(reason == nullptr ? "unknown error" : reason) + "; " + remedy));
}

void hint_opengl_3_2() {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
}

ScreenScale screen_scale(GLFWwindow* window) {
  ScreenScale scale;
  scale.density = density_of(window);
  scale.mm_per_unit = kMmPerInch / 96.0 / static_cast<double>(scale.density);
  GLFWmonitor* monitor = monitor_of(window);
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  if (mode == nullptr) return scale;
  if (mode->refreshRate > 0) scale.refresh_hz = mode->refreshRate;
  int width_mm = 0;
  glfwGetMonitorPhysicalSize(monitor, &width_mm, nullptr);
  const double stated_scale = stated_mm_per_unit(width_mm, mode->width);
  if (stated_scale > 0.0) scale.mm_per_unit = stated_scale;
  scale.monitor = identity_of(monitor, *mode);
  const auto measured_screen = measured_screens.find(scale.monitor);
  scale.is_measured = measured_screen != measured_screens.end();
  if (scale.is_measured) scale.mm_per_unit = measured_screen->second;
  scale.is_known =
      scale.is_measured || (stated_scale > 0.0 && !is_default_size(width_mm, mode->width));
  return scale;
}

bool is_default_size(int size_mm, int width) noexcept {
  return std::abs(width * kMmPerInch / 96.0 - size_mm) < 1.0;
}

double stated_mm_per_unit(int size_mm, int width) noexcept {
  if (size_mm <= 0 || width <= 0) return 0.0;
  const double mm_per_unit = static_cast<double>(size_mm) / width;
  const bool is_plausible = mm_per_unit <= kMmPerInch / 40.0 && mm_per_unit >= kMmPerInch / 400.0;
  return is_plausible ? mm_per_unit : 0.0;
}

engine::ColourImage capture_frame(int width, int height) {
  std::vector<unsigned char> bytes(static_cast<std::size_t>(width) * height * 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
  engine::ColourImage picture(height, width);
  for (int y = 0; y < height; ++y) {
    const unsigned char* row = bytes.data() + static_cast<std::size_t>(height - 1 - y) * width * 3;
    for (int x = 0; x < width; ++x) {
      picture.at(y, x) = {row[3 * x], row[3 * x + 1], row[3 * x + 2]};
    }
  }
  return picture;
}

}  // namespace touchtrial::app

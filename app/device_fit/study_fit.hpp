/// \file Whether a study's plane fits a driver's devices, with or without one at hand.
#pragma once

#include "device/registry.hpp"
#include "device/workspace_fit.hpp"
#include "protocols/design/study.hpp"

#include <optional>
#include <string>

namespace touchtrial::app {

/// Where a workspace is known from.
enum class WorkspaceSource {
  maker,   ///< what the maker states of all these devices; none was asked
  device,  ///< the device that is plugged in
  none,    ///< the device speaks the plane frame: it has all the room there is
};

struct StudyFit {
  std::string study;
  std::string driver;
  PlaneGeometry plane;
  std::optional<device::Workspace> workspace;
  WorkspaceSource source = WorkspaceSource::none;
  device::WorkspaceFit fit;
};

/// The part of the plane that all pictures of a study have, as a session presents it.
/// \throws FileError if a picture cannot be read
[[nodiscard]] PlaneGeometry common_plane_of(const design::Study& study);

/// \param orientation  nothing: as the settings say
/// \throws UsageError if there is no such driver; DeviceError if only a device could tell its
///   workspace and none can be opened; as common_plane_of
[[nodiscard]] StudyFit fit_study(const design::Study& study, const std::string& driver,
                                 const device::DeviceSettings& settings,
                                 std::optional<device::PlaneOrientation> orientation);

[[nodiscard]] std::string fit_text(const StudyFit& fit);
/// Documented in docs/devices/README.md.
[[nodiscard]] std::string fit_json(const StudyFit& fit);

}  // namespace touchtrial::app

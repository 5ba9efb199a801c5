/// \file Thresholds measured by a laboratory, used in place of a published curve.
#pragma once

#include "device/model/device_model.hpp"
#include "protocols/simulation/level_gains.hpp"
#include "study/study.hpp"

namespace touchtrial::app {

/// The curve that a study's levels refer to. With a database of pilots' detection thresholds, it is
/// israr_2006 shifted by the mean difference, over people and stimuli, between these thresholds and
/// those of the median simulated person on this device. Source: docs/perception.md, "Pilots".
/// \param device  the study's
/// \pre the study has a level
/// \throws StudyError naming /rendering/gains/curve if the database is not an unblinded detection
///   study along gain with key and pack, or fewer than three people have a threshold in it
[[nodiscard]] simulation::LevelCurve curve_of(const study::Study& study,
                                              const device::DeviceModel& device);

}  // namespace touchtrial::app

/// \file The contact sheet of a prepared study, for the lab book: the stimulus of every code, its
/// picture and its strength. It unblinds whoever reads it.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/pack/pack.hpp"
#include "engine/pictures/colour_image.hpp"
#include "engine/pictures/force_arrows.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "protocols/design/study_key.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Documents with more stimuli are too large to open.
inline constexpr std::size_t kMaxSheetStimuli = 500;
/// The most stimuli side by side.
inline constexpr std::size_t kMaxSheetColumns = 5;

/// One stimulus.
struct SheetCard {
  std::string label;
  std::string exemplar;  ///< "2 of 5"; empty if the class has one image
  std::string method;    ///< in words, with its main option
  std::string code;
  std::string image;            ///< name of its file
  GreyImage picture;            ///< the image, at most side_px wide and high
  engine::ColourImage texture;  ///< its texture at the same size, with a frame round the patch
  engine::ColourImage arrows;   ///< the forces in the patch, square, side_px
  PlaneGeometry geometry;
  engine::ArrowPatch patch;
  double arrow_n = 0.0;  ///< the force of an arrow that is one pixel of the patch long
  engine::FieldStatistics statistics;
  engine::Gains gains;
  double picture_entropy = 0.0;  ///< nats
  double texture_entropy = 0.0;  ///< nats, of the texture's picture
  std::string level;             ///< re published thresholds, in words: "12 to 31 dB"; may be empty
};

struct StimulusSheet {
  std::string study;
  std::string protocol;
  std::string rendering;  ///< in words
  std::string seal;       ///< hexadecimal
  bool simulated = false;
  int side_px = 0;                            ///< of the square that every picture fits in
  std::vector<std::vector<SheetCard>> lines;  ///< of at most kMaxSheetColumns
  std::string level_of{};                     ///< the device of the cards' levels, in words
};

/// Reads fields from the pack and pictures from the study's images. Lines are sorted by method,
/// then by class; classes with several images have their own lines.
/// \param side_px  of the pictures, >= 1
/// \param progress  called after each stimulus with the number done and their total; may be empty
/// \throws VerificationError if the pack is not the key's, or a field is damaged or not made from
///   its image: the remedy is to prepare the study again
/// \throws UsageError if there are more than kMaxSheetStimuli
/// \throws FileError if an image or a field cannot be read
[[nodiscard]] StimulusSheet make_stimulus_sheet(
    const design::StudyKey& key, const engine::Pack& pack, int side_px,
    const std::function<void(int done, int of)>& progress = {});

/// One HTML document that needs no other file and no network; printed, one A4 page for each line.
[[nodiscard]] std::string sheet_html(const StimulusSheet& sheet);

}  // namespace touchtrial::analysis

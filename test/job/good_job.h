#pragma once

#include <gtest/gtest.h>

#include <string>

namespace grinder::test_support {

/// A job file. Lines that rows of tests name are those of this text.
inline const std::string kGoodJob =
    "cutter:\n"                                      // 1
    "  end_diameter_mm: 6\n"                         // 2
    "  cone_angle_deg: -1\n"                         // 3
    "  spiral_angle_deg: -45\n"                      // 4
    "  rake_angle_deg: 12\n"                         // 5
    "  flute_length_mm: 25\n"                        // 6
    "  teeth: 4\n"                                   // 7
    "  cut: left_hand\n"                             // 8
    "  rake_tolerance_deg: 0.25\n"                   // 9
    "  chordal_rake_tolerance_deg: 5\n"              // 10
    "  spiral_tolerance_deg: 0.5\n"                  // 11
    "  core_diameter_mm: 3.5\n"                      // 12
    "  core_diameter_end_mm: 3\n"                    // 13
    "  core_tolerance_mm: 0.05\n"                    // 14
    "  shank_diameter_mm: 10\n"                      // 15
    "process:\n"                                     // 16
    "  feed_mm_min: 200\n"                           // 17
    "  depth_mm: 1.5\n"                              // 18
    "  infeed_mm: 0.5\n"                             // 19
    "  finish_infeed_mm: 0.05\n"                     // 20
    "  spark_out: 1\n"                               // 21
    "  clearance_mm: 5\n"                            // 22
    "  overtravel_mm: [1, 2]\n"                      // 23
    "  order: pass_major\n"                          // 24
    "  direction: to_end\n"                          // 25
    "  wheel:\n"                                     // 26
    "    diameter_mm: 100\n"                         // 27
    "    width_mm: 8\n"                              // 28
    "    wear_mm: 0.3\n"                             // 29
    "    profile: angled\n"                          // 30
    "    angle_deg: 20\n"                            // 31
    "    side: lower\n"                              // 32
    "    corner_radius_mm: [0.1, 0.2]\n"             // 33
    "  setup: {swivel_deg: -46, height_mm: 1.25}\n"  // 34
    "interpolation:\n"                               // 35
    "  even_step: third_order\n"                     // 36
    "  tolerance_um: 2\n"                            // 37
    "  rotary_scale_mm_per_rad: 1.5\n";              // 38

/// The good job's text, or another, with one piece of it replaced.
inline std::string with(const std::string& piece, const std::string& replacement, std::string text = kGoodJob) {
  const auto at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), replacement);
}

}  // namespace grinder::test_support

#pragma once

#include "flute_grinder/check/collision_check.h"

#include <functional>
#include <vector>

namespace grinder {

/// The search for the closest place on a path, for one pair of bodies after another. A part of the path is dropped as
/// soon as the separating planes at its middle show that it holds no closer place than the closest so far; otherwise it
/// is halved in space, so that strokes beside each other are treated as one.
class ClosestSearch {
 public:
  /// @param path points with straight legs.
  /// @param height height added to Z [m].
  /// @param searched whether to search a leg; without it, every leg is searched.
  ClosestSearch(const std::vector<Axes>& path, double height,
                const std::function<bool(std::size_t leg)>& searched = {});

  void visit(const CollisionCheck::Pair& pair);

  const ClosestPlace& best() const noexcept { return best_; }

 private:
  /// A piece of a leg, as fractions of the leg.
  struct Piece {
    std::size_t leg;
    double from, to;
  };
  using Pieces = std::vector<Piece>;
  using Box = Eigen::AlignedBox3d;

  Axes at(std::size_t leg, double fraction) const;
  Eigen::Vector3d place(std::size_t leg, double fraction) const;
  void search(const CollisionCheck::Pair& pair, const Pieces& pieces);
  Pieces half(const Pieces& pieces, int axis, double limit, bool upper) const;

  const std::vector<Axes>& path_;
  Eigen::Vector3d height_;
  Pieces all_;
  ClosestPlace best_;
};

}  // namespace grinder

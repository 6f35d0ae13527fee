#pragma once

#include "flute_grinder/collision/collision_check.h"

#include <functional>
#include <vector>

namespace grinder {

/// The search for the closest place on a path, of one pair of bodies after another: a part of the path is left as soon
/// as the planes that part the bodies in its middle show that it holds no place closer than the closest so far; if not,
/// it is halved in space, so that strokes beside each other are treated as one.
class ClosestSearch {
 public:
  /// @param path points with straight legs. @param height added to Z [m]. @param searched whether a leg is; without
  ///        it, every leg is.
  ClosestSearch(const std::vector<Axes>& path, double height,
                const std::function<bool(std::size_t leg)>& searched = {});

  void visit(const CollisionCheck::Pair& pair);

  const ClosestPlace& best() const noexcept { return best_; }

 private:
  /// A piece of a leg, as fractions of it.
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

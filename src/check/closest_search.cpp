#include "check/closest_search.h"

#include <algorithm>
#include <array>
#include <map>

namespace grinder {

namespace {

constexpr double kSearchAccuracy = 1e-6;  ///< accuracy of the search, added to the error of gap() [m]

}  // namespace

ClosestSearch::ClosestSearch(const std::vector<Axes>& path, double height,
                             const std::function<bool(std::size_t leg)>& searched)
    : path_(path), height_(0, 0, height) {
  // The strokes of all teeth coincide, since A makes no difference.
  std::map<std::array<double, 6>, bool> seen;
  for (std::size_t leg = 0; leg + 1 < std::max<std::size_t>(path.size(), 2); ++leg) {
    if (searched && !searched(leg)) continue;
    const Axes& from = path[leg];
    const Axes& to = path[std::min(leg + 1, path.size() - 1)];
    if (seen.try_emplace({from[kX], from[kY], from[kZ], to[kX], to[kY], to[kZ]}, true).second)
      all_.push_back({leg, 0, 1});
  }
}

void ClosestSearch::visit(const CollisionCheck::Pair& pair) {
  if (best_.distance > 0 && !all_.empty()) search(pair, all_);
}

Axes ClosestSearch::at(std::size_t leg, double fraction) const {
  const Axes& to = path_[std::min(leg + 1, path_.size() - 1)];
  return (1 - fraction) * path_[leg] + fraction * to;
}

Eigen::Vector3d ClosestSearch::place(std::size_t leg, double fraction) const {
  return at(leg, fraction).head<3>().matrix() + height_;
}

void ClosestSearch::search(const CollisionCheck::Pair& pair, const Pieces& pieces) {
  Box box;
  for (const Piece& piece : pieces) box.extend(place(piece.leg, piece.from)).extend(place(piece.leg, piece.to));
  const Piece& middle = pieces[pieces.size() / 2];
  const double fraction = (middle.from + middle.to) / 2;
  const Eigen::Vector3d here = place(middle.leg, fraction);
  const Gap space = gap(pair.first, pair.second, pair.motion * here);
  if (space.distance < std::min(best_.distance, pair.below)) {
    best_ = {space.distance, pair.first.name, pair.second.name, at(middle.leg, fraction), middle.leg};
  }
  if (!(best_.distance > 0)) return;

  const Eigen::Vector3d slope = pair.motion.transpose() * space.normal;
  double bound = space.distance;
  for (const Piece& piece : pieces) {
    for (const double end : {piece.from, piece.to}) {
      bound = std::min(bound, space.distance + slope.dot(place(piece.leg, end) - here));
    }
  }
  if (bound >= std::min(best_.distance, pair.below) - kSearchAccuracy) return;

  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const double limit = box.center()[axis];
  const bool upper_first = slope[axis] < 0;
  for (const bool upper : {upper_first, !upper_first}) {
    const Pieces part = half(pieces, axis, limit, upper);
    if (!part.empty()) search(pair, part);
  }
}

ClosestSearch::Pieces ClosestSearch::half(const Pieces& pieces, int axis, double limit, bool upper) const {
  Pieces part;
  for (const Piece& piece : pieces) {
    const double sign = upper ? 1 : -1;
    const double from = sign * (place(piece.leg, piece.from)[axis] - limit);
    const double to = sign * (place(piece.leg, piece.to)[axis] - limit);
    if (upper ? from < 0 && to < 0 : from <= 0 && to <= 0) continue;
    Piece rest = piece;
    if (from < 0 || to < 0) {
      const double crossing = piece.from + (piece.to - piece.from) * from / (from - to);
      (from < 0 ? rest.from : rest.to) = crossing;
    }
    part.push_back(rest);
  }
  return part;
}

}  // namespace grinder

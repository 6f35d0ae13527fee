#include "report/envelope.h"

#include <algorithm>

namespace grinder {

namespace {

constexpr int kColumns = 450;  ///< columns, about as many as a picture has pixels across

}  // namespace

Envelope::Envelope(double low, double high, std::uint64_t points, std::size_t curves)
    : low_(low),
      width_(high > low ? (high - low) / kColumns : 1),
      is_exact_(points <= 2 * kColumns),
      curves_(curves),
      columns_(is_exact_ ? 0 : kColumns) {}

void Envelope::add(double x, const double* y) {
  if (is_exact_) {
    x_.push_back(x);
    y_.insert(y_.end(), y, y + curves_);
    return;
  }
  const int at = std::clamp(static_cast<int>((x - low_) / width_), 0, kColumns - 1);
  Column& column = columns_[static_cast<std::size_t>(at)];
  if (column.min.empty()) column.min = column.max = std::vector<double>(y, y + curves_);
  for (std::size_t i = 0; i < curves_; ++i) {
    column.min[i] = std::min(column.min[i], y[i]);
    column.max[i] = std::max(column.max[i], y[i]);
  }
}

Json Envelope::json() const {
  Json x = Json::array(), y = Json::array();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x.push_back(x_[i]);
    const auto from = y_.begin() + static_cast<std::ptrdiff_t>(i * curves_);
    y.push_back(std::vector<double>(from, from + static_cast<std::ptrdiff_t>(curves_)));
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].min.empty()) continue;
    for (const std::vector<double>& values : {columns_[i].min, columns_[i].max}) {
      x.push_back(low_ + (static_cast<double>(i) + 0.5) * width_);
      y.push_back(values);
    }
  }
  return {{"exact", is_exact_}, {"width", width_}, {"x", x}, {"y", y}};
}

}  // namespace grinder

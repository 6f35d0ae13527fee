#pragma once

#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/tool/end_view.h"

#include <QPainter>
#include <QRectF>

namespace grinder {

/// Draws the end of a tool, seen along its axis and turned until the first tooth's edge is at the top, with a legend of
/// its faces. The dashed circle is the uncut diameter that the job allows, the dotted one where short edges begin.
void paintEnd(QPainter& painter, const QRectF& sheet, const ValidJob& job, const EndView& end);

}  // namespace grinder

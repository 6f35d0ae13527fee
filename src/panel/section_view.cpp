#include "panel/section_view.h"

#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/tool/z_law.h"
#include "panel/plain_words.h"
#include "panel/text_view.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <exception>

namespace grinder {

namespace {

using units::kMillimetre;

constexpr int kPausePerWork = 9;
constexpr int kXDecimals = 2;  ///< decimals of X, the finest step of a section

template <typename Value>
bool isReady(const std::future<Value>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

SectionView::SectionView(QWidget* parent)
    : QWidget(parent),
      x_(new NumberBox("section_x", kXDecimals)),
      follow_(new QCheckBox("Follow the wheel")),
      drawing_(new SectionDrawing),
      figures_(namedLabel("section_figures")) {
  x_->setSingleStep(0.5);
  x_->setSuffix(" mm");
  x_->setKeyboardTracking(false);
  x_->setToolTip("Distance of the section from the small end");
  follow_->setObjectName("follow_wheel");
  follow_->setToolTip("Show the section at the wheel's X");
  drawing_->setObjectName("section");
  figures_->setWordWrap(true);
  figures_->setToolTip("In brackets: what the job asks for, and its tolerance");
  figures_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  figures_->setMinimumHeight(5 * figures_->fontMetrics().lineSpacing() + 4);
  auto* choice = new QHBoxLayout;
  choice->addWidget(new QLabel("X"));
  choice->addWidget(x_, 1);
  choice->addWidget(follow_);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addLayout(choice);
  layout->addWidget(drawing_, 1);
  layout->addWidget(figures_);
}

void SectionView::refresh(const GrinderView& view, const Job& job) {
  if (!isVisible()) return;
  if (job != job_) setJob(job);
  const bool has_sections = job_ && !isStraight(job_->process().kind);
  x_->setEnabled(has_sections && !follow_->isChecked());
  follow_->setEnabled(has_sections);
  const QString nothing = whyNothing(view);
  if (!nothing.isEmpty()) {
    wanted_.reset();
    return show(nullptr, nothing);
  }
  if (has_sections && follow_->isChecked()) follow((*view.work_position)[kX]);
  if (isReady(computing_)) take(computing_.get());
  const Wanted now{job_, x_->value(), with_law_};
  if (computing_.valid() || now == wanted_ || Clock::now() < earliest_) return;
  wanted_ = now;
  computing_ = std::async(std::launch::async, computed, now);
}

void SectionView::take(const Computed& computed) {
  earliest_ = Clock::now() + kPausePerWork * computed.took;
  if (computed.job != job_) return;
  with_law_ = computed.with_law;
  show(computed.section, computed.text);
}

SectionView::Computed SectionView::computed(const Wanted& wanted) {
  const auto begin = Clock::now();
  std::optional<ValidJob> job = wanted.with_law;
  const auto failed = [&](const std::string& text) -> Computed {
    return {wanted.job, nullptr, QString::fromStdString(text).toHtmlEscaped(), Clock::now() - begin, job};
  };
  try {
    if (!job) job = withLaws(ValidJob(*wanted.job));
    // The flute length may have more decimals than the box.
    const double x = std::min(wanted.x * kMillimetre, (*job)->cutter.flute_length);
    const auto section = std::make_shared<const CutterSection>(cutterSection(*job, x));
    return {wanted.job, section, figuresText(*section), Clock::now() - begin, job};
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

void SectionView::setJob(const Job& job) {
  const bool other_length = job && (!job_ || job_->cutter.flute_length != job->cutter.flute_length);
  job_ = job;
  with_law_.reset();
  digest_ = job ? jobDigest(*job) : "";
  if (!other_length) return;
  const double length = job->cutter.flute_length / kMillimetre;
  x_->setRange(0, length);
  x_->setValue(length / 2);
}

/// Why no section can be shown; empty if one can.
QString SectionView::whyNothing(const GrinderView& view) const {
  if (!job_) return "No job is chosen, none of its operations is, or its file has an error.";
  if (isStraight(job_->process().kind)) return "";
  if (!follow_->isChecked()) return x_->isGood() ? "" : "Allowed X: " + x_->allowed() + ".";
  if (!view.work_position || !std::isfinite((*view.work_position)[kX])) return "No position comes from the grinder.";
  if (!view.state || !isInJob(static_cast<MachineState>(view.state->state))) return "";
  const flute_grinder::JobProgress& running = view.state->progress;
  if (running.job_digest == digest_) return "";
  return "The grinder runs " + QString::fromStdString(describe(running)).toHtmlEscaped() +
         ". This is not the chosen job, and only the chosen job's section can be shown, at an X of your choice.";
}

/// Chooses the section at the wheel, or at the nearest end of the flute.
void SectionView::follow(double x) {
  const QSignalBlocker programmatic(x_);
  x_->setValue(x / kMillimetre);
}

void SectionView::show(const std::shared_ptr<const CutterSection>& section, const QString& text) {
  drawing_->setSection(section);
  drawing_->setVisible(section != nullptr);
  if (figures_->text() != text) figures_->setText(text);
}

}  // namespace grinder

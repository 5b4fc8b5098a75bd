#pragma once

#include "app/described/value.h"
#include "app/session/session.h"

namespace tessera::app {

// Types of sessions and of what they are made of. Their descriptions are much to compile: session_types.cpp alone does.
extern template const ValueType& valueType<Animation>();
extern template const ValueType& valueType<Callout>();
extern template const ValueType& valueType<CompareVariant>();
extern template const ValueType& valueType<CompareView>();
extern template const ValueType& valueType<CurvesView>();
extern template const ValueType& valueType<DataFile>();
extern template const ValueType& valueType<DataRef>();
extern template const ValueType& valueType<DataView>();
extern template const ValueType& valueType<DockNode>();
extern template const ValueType& valueType<HierarchyView>();
extern template const ValueType& valueType<HistogramView>();
extern template const ValueType& valueType<HistoryView>();
extern template const ValueType& valueType<HyperSliceView>();
extern template const ValueType& valueType<LayersView>();
extern template const ValueType& valueType<LogView>();
extern template const ValueType& valueType<ObliqueView>();
extern template const ValueType& valueType<ParallelCoordinatesView>();
extern template const ValueType& valueType<PiecesView>();
extern template const ValueType& valueType<Probe>();
extern template const ValueType& valueType<ProbesView>();
extern template const ValueType& valueType<ProfileView>();
extern template const ValueType& valueType<Scatter3dView>();
extern template const ValueType& valueType<ScatterMatrixView>();
extern template const ValueType& valueType<Session>();
extern template const ValueType& valueType<ShadowCubeView>();
extern template const ValueType& valueType<SliceMatrixView>();
extern template const ValueType& valueType<SlicesView>();
extern template const ValueType& valueType<StatisticsView>();
extern template const ValueType& valueType<TesseractView>();
extern template const ValueType& valueType<TimelineView>();
extern template const ValueType& valueType<Track>();
extern template const ValueType& valueType<TransferView>();
extern template const ValueType& valueType<VolumeView>();
extern template const ValueType& valueType<WorthSeeingView>();
extern template const ValueType& valueType<vis::BoundaryEnhancement>();
extern template const ValueType& valueType<vis::BoxRegion>();
extern template const ValueType& valueType<vis::Brush>();
extern template const ValueType& valueType<vis::Camera>();
extern template const ValueType& valueType<vis::Cartoon>();
extern template const ValueType& valueType<vis::CharcoalDrawing>();
extern template const ValueType& valueType<vis::Clip>();
extern template const ValueType& valueType<vis::DistanceColor>();
extern template const ValueType& valueType<vis::EllipseRegion>();
extern template const ValueType& valueType<vis::FlowLayer>();
extern template const ValueType& valueType<vis::GlyphLayer>();
extern template const ValueType& valueType<vis::GlyphPart>();
extern template const ValueType& valueType<vis::IsoLayer>();
extern template const ValueType& valueType<vis::LassoRegion>();
extern template const ValueType& valueType<vis::Layer>();
extern template const ValueType& valueType<vis::Lens>();
extern template const ValueType& valueType<vis::LensRegion>();
extern template const ValueType& valueType<vis::Light>();
extern template const ValueType& valueType<vis::Lighting>();
extern template const ValueType& valueType<vis::Look>();
extern template const ValueType& valueType<vis::Paper>();
extern template const ValueType& valueType<vis::RenderParams>();
extern template const ValueType& valueType<vis::Selection>();
extern template const ValueType& valueType<vis::SilhouetteEnhancement>();
extern template const ValueType& valueType<vis::SliceLayer>();
extern template const ValueType& valueType<vis::SphereRegion>();
extern template const ValueType& valueType<vis::Strokes>();
extern template const ValueType& valueType<vis::Tone>();
extern template const ValueType& valueType<vis::TransferFunction>();
extern template const ValueType& valueType<vis::TransferRegion>();
extern template const ValueType& valueType<vis::VolumeLayer>();
extern template const ValueType& valueType<vis::WarmCool>();
extern template const ValueType& valueType<volume::DerivedParameter>();
extern template const ValueType& valueType<volume::DifferenceRecipe>();
extern template const ValueType& valueType<volume::ExpressionRecipe>();
extern template const ValueType& valueType<volume::PiecesRecipe>();
extern template const ValueType& valueType<volume::SmoothRecipe>();
extern template const ValueType& valueType<volume::UncertaintyRecipe>();

} // namespace tessera::app

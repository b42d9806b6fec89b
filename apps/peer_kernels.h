// The two kernels behind peerOcclusion(): private to it.
#pragma once

#include "obscura/apps/peer_methods.h"

namespace obscura::apps {

void peerVolumes(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out, raster::Target target);
void peerHorizons(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out, raster::Target target);

}  // namespace obscura::apps

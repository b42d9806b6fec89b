#include "obscura/apps/figure.h"

namespace obscura::apps {

const std::vector<Figure>& allFigures() {
  static const std::vector<Figure> figures = {
      {"membership", "Membership functions",
       "Szirmay-Kalos, Toth, Umenhoffer, Efficient methods for ambient lighting: figure 1 of the long version",
       "How open a direction counts, by the distance d of what blocks it. Plain ambient occlusion knows only blocked and open; the others fade, so that "
       "occluders lose their effect before they reach R.",
       makeMembershipFigure},
      {"containment", "Containment tests instead of rays",
       "Efficient methods for ambient lighting: figure 1 of the short version, figures 2 and 3 of the long one",
       "A section through a surface; what is inside is grey. Rays 1 and 2 meet the surface at most once, so whether their end is inside tells whether they are blocked. "
       "Ray 3 meets it twice: its end is outside, though it is blocked. The depth map, seen by an eye far above and to the left, takes all that it does not see for inside, "
       "and with its bound only what lies less than R behind.",
       makeContainmentFigure},
      {"tree", "Obscurances of a tree with stones",
       "Efficient methods for ambient lighting: figure 2 of the short version",
       "Environment light alone looks flat, as nothing shades anything. O is dark in crevices, under stones and in the crown; the light times O shows how leaves, "
       "grass and stones lie against one another.",
       makeTreeFigure},
      {"carved", "The ambient transfer function of a carved object",
       "Efficient methods for ambient lighting: figure 3 of the short version, figure 9 of the long one",
       "The albedo is (0.6, 0.3, 0.3). O makes the grooves too dark, since it takes what occludes to be black. W adds what the walls of the grooves reflect: they "
       "are brighter, and redder, because red is what the stone reflects. So W alone has a colour.",
       makeCarvedFigure},
      {"interleaving", "The pattern of interleaved sampling",
       "Efficient methods for ambient lighting: figure 4 of the long version",
       "Each colour is one of 16 turned copies of a sample set. Wherever a 4 x 4 window lies, it has each of them once, so that the mean over it has 16 times as many "
       "test points: on the right those of n = 8, seen along the normal.",
       makeInterleavingFigure},
      {"sampling", "Samples a pixel, and interleaved sampling",
       "Efficient methods for ambient lighting: figure 5 of the long version",
       "Left: the same rays in all pixels give stripes and bands. Right: other rays in each pixel of a 4 x 4 pattern, and the mean over a window of it, count as 16 "
       "times as many: the bands are gone already with few samples.",
       makeSamplingFigure},
      {"silhouettes", "False silhouettes",
       "Efficient methods for ambient lighting: figures 6 and 7 of the long version",
       "A door in front of a corridor that is far behind it. Left, whatever lies behind the depth map counts as blocked: the door's edges have a dark seam on the "
       "corridor. Right, what lies R or more behind does not: the seam is gone, the corners of the corridor stay.",
       makeSilhouettesFigure},
      {"relief", "Height field and depth map",
       "Efficient methods for ambient lighting: figure 3 of the long version, and its section 6",
       "A floor displaced by a height map, and a block on it. The depth map sees that the block shades the floor, but of the relief only what the eye sees. The "
       "height field knows all of the relief and nothing of the block. Together they have both.",
       makeReliefFigure},
      {"harbour", "A harbour",
       "Efficient methods for ambient lighting: figure 8 of the long version",
       "The light of the sky alone leaves boats, crates and houses without contact to the ground; times W they stand on it, and corners and gaps have depth.",
       makeHarbourFigure},
      {"white-room", "The corner of a white room",
       "Efficient methods for ambient lighting: the interpretation of W below equation 4 (short) and 6 (long version)",
       "O darkens the corner, whatever its colour. In a white room light is reflected to and fro until it is as bright as the wall: W is 1, exactly, everywhere. The "
       "darker the paint, the more of the darkening stays.",
       makeWhiteRoomFigure},
      {"snow", "Snow loses its bumps",
       "Efficient methods for ambient lighting: the interpretation of W below equation 4 (short) and 6 (long version)",
       "In fog, where light comes from everywhere, skiers do not see the bumps of snow, as it reflects nearly all light. The same slope is shown as earth and as snow: "
       "tracks and bumps are plain on earth and in O, and gone in W of the snow.",
       makeSnowFigure},
      {"extended", "The extended ambient term",
       "Castro, Neumann, Sbert, Extended Ambient Term: figures 1 and 2",
       "A grey room with a red and a green wall, a white sphere and a square lamp. With the constant term the sphere is a flat disc. With the extended one its left side, "
       "which faces the red wall, turns reddish, the right one greenish, with a smooth transition. Below with the lamp's own light and shadows, and with W, which adds the "
       "occlusion that both terms lack.",
       makeExtendedFigure},
      {"highlight", "Thresholded and plain highlight",
       "Akenine-Moller, Haines, Hoffman, Real-Time Rendering, 3rd edition: figure 8.7",
       "Smooth, glossy things under two lights. Right, the Blinn-Phong highlight fades out. Left, its value is thresholded: an even spot with a sharp edge, as the mirror "
       "image of a round lamp would be.",
       makeHighlightFigure},
      {"projections", "Four projections of one environment",
       "Akenine-Moller, Haines, Hoffman, Real-Time Rendering, 3rd edition: section 8.4",
       "The same sky in the four ways in which a texture can hold all directions: longitude and latitude; the picture of a mirror ball, whose rim shows all that is behind it; "
       "six faces of a cube; two paraboloids.",
       makeProjectionsFigure},
      {"armour", "A bumped, environment-mapped armour",
       "Akenine-Moller, Haines, Hoffman, Real-Time Rendering, 3rd edition: figure 8.9",
       "The armour reflects the sky around it. Its normal map bends each reflection, so that it looks like scales of steel, though the surface is smooth. With the sky turned, "
       "other parts of it shine.",
       makeArmourFigure},
  };
  return figures;
}

}  // namespace obscura::apps

//! The rows of the effects. A row is data.

use super::Effect;

/// Returns a row. Its description is the file of this name.
macro_rules! row {
    ($name:literal, $summary:literal, $source:literal, reads: $reads:expr, $arguments:expr) => {
        Effect {
            name: $name,
            summary: $summary,
            source: $source,
            path: concat!("examples/effects/", $name, ".fragbuf"),
            text: include_str!(concat!("../../../examples/effects/", $name, ".fragbuf")),
            reads: $reads,
            arguments: $arguments,
        }
    };
}

/// Every effect.
pub(crate) const EFFECTS: &[Effect] = &[
    row!(
        "transparency",
        "surfaces of one opacity, which reflect two lamps",
        "B06 §4.1",
        reads: None,
        &[
            ("--scene", "builtin:marbles,n=40,seed=7"),
            ("--size", "960x540"),
            ("--camera", "orbit:10,20,zoom:1.15"),
            ("--shading", "unlit"),
            ("--uniform", "alpha=0.4"),
            ("--uniform", "camera=camera"),
            ("--set", "samples=coverage"),
        ]
    ),
    row!(
        "translucency",
        "solids that absorb light, by the length of the ray inside of them, with Fresnel's transmittance",
        "B06 §4.1",
        reads: None,
        &[
            ("--scene", "builtin:knot,turns=5,thickness=17,rings=600,sides=48"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20"),
            ("--uniform", "absorption=3.2,0.8,2.0"),
            ("--uniform", "camera=camera"),
            ("--set", "samples=coverage"),
        ]
    ),
    row!(
        "csg",
        "a boolean expression over solids, with caps, also where faces are coplanar",
        "B06 §4.1, D13 §4",
        reads: None,
        &[
            ("--scene", "builtin:part,sides=128"),
            ("--size", "960x540"),
            ("--camera", "orbit:30,32,zoom:1.15"),
            ("--shading", "unlit"),
            ("--uniform", "equal=0.00002"),
            ("--set", "samples=coverage"),
        ]
    ),
    row!(
        "wireframe",
        "lines along all edges of triangles over translucent surfaces",
        "D13 §4",
        reads: None,
        &[
            ("--scene", "builtin:knot,turns=5,thickness=17,rings=150,sides=10"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20"),
            ("--shading", "unlit"),
            ("--uniform", "width=0.014"),
            ("--uniform", "alpha=0.35"),
            ("--set", "samples=coverage"),
        ]
    ),
    row!(
        "self_collision",
        "where a model runs into itself, in red, seen through it",
        "D13 §4",
        reads: None,
        &[
            ("--scene", "builtin:knot,turns=5,thickness=50,rings=500,sides=48"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20,zoom:1.05"),
            ("--shading", "unlit"),
            ("--uniform", "alpha=0.3"),
            ("--set", "samples=coverage"),
        ]
    ),
    row!(
        "winding_number",
        "the greatest winding number along a ray, as a colour",
        "D13 §4",
        reads: None,
        &[
            ("--scene", "builtin:knot,turns=5,thickness=60,rings=500,sides=48"),
            ("--size", "960x540"),
            ("--shading", "unlit"),
            ("--uniform", "least=0.02"),
            ("--set", "samples=coverage"),
            ("--camera", "orbit:15,20"),
        ]
    ),
    row!(
        "self_trimmed",
        "the solid that a rule for winding numbers makes of a surface that crosses itself",
        "D13 §4",
        reads: None,
        &[
            ("--scene", "builtin:knot,turns=7,thickness=55,rings=700,sides=64"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20,zoom:1.25"),
            ("--shading", "unlit"),
            ("--uniform", "rule=2"),
            ("--set", "samples=coverage"),
        ]
    ),
    row!(
        "coplanarity",
        "how many fragments of a pixel have the depth of another one",
        "D13 Fig. 13",
        reads: None,
        &[
            ("--scene", "builtin:building"),
            ("--size", "960x540"),
            ("--camera", "orbit:30,20,zoom:1.2"),
        ]
    ),
    row!(
        "depth_complexity",
        "the number of fragments of a pixel as a heat map",
        "D13 §4",
        reads: None,
        &[
            ("--scene", "builtin:needles,n=6000"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20,zoom:1.5"),
            ("--uniform", "most=80"),
            ("--set", "samples=coverage"),
        ]
    ),
    row!(
        "midpoint",
        "the mean depth of the two nearest surfaces, as midpoint shadow maps store it",
        "B06 §4.1, Woo 1992",
        reads: Some(2),
        &[
            ("--scene", "builtin:knot,rings=400,sides=48"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20"),
            ("--background", "0,0,0,1"),
            ("--uniform", "near=0.5"),
            ("--uniform", "far=0.92"),
        ]
    ),
    row!(
        "midpoint_shadows",
        "shadows by a midpoint shadow map, which needs no bias",
        "B06 §4.1, Woo 1992",
        reads: Some(1),
        &[
            ("--scene", "builtin:knot,turns=7,thickness=22,rings=800,sides=64"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20,zoom:1.05"),
            ("--shading", "unlit"),
            ("--texture", "shadow=rendered:effect:midpoint,camera=orbit:-40,50,size=2048x2048,near=0,far=1"),
            ("--uniform", "x=shadow.x"),
            ("--uniform", "y=shadow.y"),
            ("--uniform", "z=shadow.z"),
            ("--uniform", "w=shadow.w"),
            ("--uniform", "lamp=shadow.camera"),
            ("--set", "samples=coverage"),
        ]
    ),
    row!(
        "silhouettes",
        "lines where the depth jumps, and normals, both by differences between pixels",
        "B06 §4.1",
        reads: Some(1),
        &[
            ("--scene", "builtin:knot,turns=5,thickness=24,rings=600,sides=48"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20"),
            ("--shading", "unlit"),
            ("--uniform", "camera=camera"),
            ("--uniform", "jump=0.02"),
        ]
    ),
    row!(
        "depth_of_field",
        "a foreground and a background that are blurred alone",
        "B06 §4.2",
        reads: None,
        &[
            ("--scene", "builtin:marbles,n=400,seed=2"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20,zoom:2"),
            ("--shading", "unlit"),
            ("--uniform", "camera=camera"),
            ("--uniform", "near=2.3"),
            ("--uniform", "far=3"),
        ]
    ),
    row!(
        "volume",
        "direct volume rendering of a tetrahedral mesh, integrated in closed form between its faces",
        "B06 §4.3",
        reads: None,
        &[
            ("--scene", "builtin:tets,n=16"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,50,zoom:1.3"),
            ("--background", "0.01,0.01,0.02,1"),
            ("--uniform", "density=40"),
        ]
    ),
    row!(
        "volume_table",
        "direct volume rendering by a pre-integrated table: thin shells, over a stream with a small k",
        "B06 §4.3, Engel et al. 2001",
        reads: None,
        &[
            ("--scene", "builtin:tets,n=16"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,50,zoom:1.3"),
            ("--background", "0.01,0.01,0.02,1"),
            ("--presort", "nearest"),
            ("--texture", "table=preintegrated:builtin:shells,length=0.2,extinction=25,scalars=128,lengths=32"),
            ("--uniform", "length=0.2"),
        ]
    ),
    row!(
        "isosurface",
        "where the scalar of a tetrahedral mesh has a value",
        "B06 §4.3",
        reads: None,
        &[
            ("--scene", "builtin:tets,n=20"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,50,zoom:1.2"),
            ("--uniform", "value=0.15"),
            ("--uniform", "alpha=0.6"),
        ]
    ),
    row!(
        "particles",
        "the surface that particles form together, where the sum of their fields has a value",
        "B06 §4.3, Fig. 10b",
        reads: None,
        &[
            ("--scene", "builtin:particles,n=3000,size=400"),
            ("--size", "960x540"),
            ("--camera", "orbit:15,20,zoom:1.1"),
            ("--shading", "unlit"),
            ("--uniform", "value=1.5"),
        ]
    ),
];

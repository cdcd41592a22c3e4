//! Two crossing panes of glass, in one camera with a fragment buffer.

use bevy::prelude::*;
use fragbuf_bevy::{FragmentBuffer, FragmentBufferPlugin};

fn main() -> AppExit {
    App::new().add_plugins((DefaultPlugins, FragmentBufferPlugin)).add_systems(Startup, setup).run()
}

/// Spawns a camera that stores its transparent meshes, and what it sees.
pub fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) -> Result {
    let buffer = FragmentBuffer::new(
        "buffer Glass from ab_sb {
            fragment { color: rgba16, depth: f32 }
            opaque: in_shader;
            samples: coverage;
        }",
    )?;
    let eye = Transform::from_xyz(0.0, 1.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y);
    commands.spawn((Camera3d::default(), Msaa::Sample4, eye, buffer));
    commands.spawn((DirectionalLight::default(), Transform::from_xyz(1.0, 2.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y)));
    let pane = meshes.add(Cuboid::new(2.0, 1.5, 0.02));
    for (angle, color) in [(0.8, Color::srgba(0.9, 0.2, 0.2, 0.5)), (-0.8, Color::srgba(0.2, 0.4, 0.9, 0.5))] {
        let glass = StandardMaterial { base_color: color, alpha_mode: AlphaMode::Blend, ..default() };
        let turned = Transform::from_rotation(Quat::from_rotation_y(angle));
        commands.spawn((Mesh3d(pane.clone()), MeshMaterial3d(materials.add(glass)), turned));
    }
    let ball = Mesh3d(meshes.add(Sphere::new(0.4)));
    commands.spawn((ball, MeshMaterial3d(materials.add(Color::WHITE)), Transform::from_xyz(0.5, 0.0, 0.0)));
    Ok(())
}

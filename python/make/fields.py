# SPDX-License-Identifier: MIT
"""Which headers the module covers: a field of work each is a source file of generated bindings."""

FIELDS = {
    "scenes": """
        core/trace core/up_axis core/uv_transform meshing/triangle_mesh haptic/height_field haptic/channel_field haptic/material_tag
        io/scene io/read_options io/glb_writer io/scene_file io/cad_reader io/gltf_edit""",
    "meshing": """
        meshing/chart_set meshing/repair meshing/deviation meshing/simplify meshing/triangle_budget meshing/weld
        meshing/statistics meshing/segmentation meshing/sheet_sides meshing/chart_topology meshing/identical_parts
        meshing/visibility meshing/cut_open pipeline/scene_sides pipeline/shared_parts pipeline/repair_scene
        pipeline/perception pipeline/simplify_scene pipeline/part_statistics""",
    "param": """
        param/flattening param/chart_choice param/measure param/triplanar param/natural param/projections param/maillot
        param/levy param/levy_coupling param/lscm param/reference_maps param/best param/automatic param/pack param/pack_unique
        param/seam_visibility param/seam_choice param/bounded_seams pipeline/unwrap_method pipeline/unwrap_scene pipeline/measure_scene""",
    "texture": """
        texture/fractal texture/box_dimension texture/fshot_dimension texture/best_dimension
        texture/probability_dimension texture/fractal_readings texture/feature_matrix texture/lattice
        texture/lattice_deformation texture/lattice_agreement texture/primitive texture/symmetry texture/texture_class texture/wallpaper_group
        texture/frieze_group texture/tiling texture/prepare texture/roughness texture/part_roughness
        texture/even_light texture/commensurate_tile texture/height_reference texture/height_from_image texture/shape_from_shading
        texture/photometric_stereo texture/picture_relief texture/photograph_model texture/light_direction texture/light_sphere
        texture/spectral_surface texture/midpoint_surface texture/stein_surface texture/surface_like texture/grain
        texture/wave_bands texture/relief_error pipeline/texture_survey pipeline/height_file pipeline/stereo_file pipeline/synthesis""",
    "procedural": "procedural/texture pipeline/texture_files",
    "pipeline": """
        pipeline/surface_selector pipeline/object_texture_rules pipeline/object_textures pipeline/materials
        pipeline/assignment pipeline/library_material pipeline/material_library pipeline/material_suggestion pipeline/grain
        pipeline/felt_waves pipeline/bake_stages pipeline/bake_plan pipeline/bake_scene pipeline/bake_file
        pipeline/weather_scene pipeline/evaluate/evaluation pipeline/evaluate/stability""",
    "haptic": """
        haptic/trajectory haptic/stroke haptic/device haptic/safety haptic/stability haptic/tag_limits
        haptic/contact_surface haptic/contact_mesh haptic/haptic_loop haptic/registration haptic/histogram io/haptic_scene""",
}

# Bound by hand: pictures have the buffer protocol, the others are no plain structs.
CLASSES = [
    "GreyImage", "ColorImage", "RgbaImage", "LinearImage", "HeightMap", "HeightGrid",
    "RecipeLibrary", "ProceduralTexture", "Trajectory", "ContactSurface", "MaterialLibrary",
]  # fmt: skip

# Structs without a use of their own in Python: rules of the stages, and the state of a running loop in C++.
LEFT_OUT = ["StageRule", "LoopStatus", "LoopOptions", "EvaluationKind", "EvaluationInput", "FractalReading",
            "TexturePoints", "PointRaster", "PlacedMesh", "EvaluationGroup", "HeightRows",
            "GltfSurfaceEdit", "GltfEdit", "EncodedRelief", "EncodedMaps", "BudgetPart", "MeshSheets", "ComparedPart",
            "SelectorKey", "PixelRelief", "IdenticalOptions", "AssignedPart", "ObjectTextureOptions", "HeightField",
            "GltfSource", "GltfTagEdit", "SeamTools", "CoarseSurface", "ChartedMap", "BoundedSeams"]  # fmt: skip

# Small structs of numbers that come in large numbers: vectors of them are structured arrays.
STRUCTURED = ["TraceSample", "TriangleDistortion", "ScalePoint", "RecordRow", "WeldStep", "Instance"]


def header_files(field):
    return FIELDS[field].split()

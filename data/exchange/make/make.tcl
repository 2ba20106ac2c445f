# SPDX-License-Identifier: MIT
# DRAW's part of make.sh: parts of the cockpit as DRAW's own commands write them, and coarse meshes for Blender.
pload MODELING OCAF XDE
set out $env(OUT)
set work $env(WORK)
ReadStep Cockpit $env(COCKPIT)
set parts {vent_frame vent_slat vent_slider knob_cap steering_column door_handle_pull}
for {set i 1} {$i <= 46} {incr i} {
  set name [GetName Cockpit 0:1:1:$i]
  if {[lsearch $parts $name] >= 0} { XGetShape $name Cockpit 0:1:1:$i }
}

# One solid.
save door_handle_pull $out/handle.brep
XNewDoc Handle
XAddShape Handle door_handle_pull 0
WriteStep Handle $out/handle.step
param write.iges.brep.mode 0
brepiges door_handle_pull $out/handle.igs
param write.iges.brep.mode 1
brepiges door_handle_pull $out/handle_solid.igs

# An assembly with a part used twice, names and colours.
copy knob_cap left
copy knob_cap right
ttranslate left -62 0 0
ttranslate right 62 0 0
compound left right steering_column knobs
XNewDoc Knobs
XAddShape Knobs knobs 1
SetName Knobs 0:1:1:1 knobs
foreach {label name r g b} {0:1:1:2 knob_cap 0.04 0.04 0.05 0:1:1:3 steering_column 0.7 0.72 0.75} {
  SetName Knobs $label $name
  XSetColor Knobs $label $r $g $b
}
WriteStep Knobs $out/knobs.step

foreach part {vent_frame vent_slat vent_slider} {
  incmesh $part 1 -a 40
  writestl $part $work/$part.stl 1
}

# SPDX-License-Identifier: BSD-3-Clause
# gnuplot -e "data='FOLDER'; out='accuracy.png'; plots='.../plots'" accuracy.gp
load plots."/style.gp"
set terminal pngcairo size 1180,820 font "DejaVu Sans,11" background "white"
set output out
set multiplot layout 2,2 margins 0.075,0.985,0.08,0.945 spacing 0.085,0.125
set format x "%g"
set xrange [0.085:1]
set xtics (0.1, 0.2, 0.4, 0.8)
set xlabel "voxel size h [mm]"
f(s) = data."/accuracy_".s.".dat"
set label 1 "● mean     △ most" at graph 0.98,0.05 right tc rgb grey

set title "Distance, smooth surfaces"
set ylabel "error of the distance [µm]"
set yrange [0.01:400]
plot f("sphere") u 1:2 w lp lc rgb blue pt 7 lw 2 t "sphere, R = 5 mm", \
     f("sphere") u 1:4 w lp lc rgb blue pt 8 dt 2 not, \
     f("cylinder") u 1:2 w lp lc rgb orange pt 7 lw 2 t "cylinder, R = 5 mm", \
     f("cylinder") u 1:4 w lp lc rgb orange pt 8 dt 2 not, \
     f("torus") u 1:2 w lp lc rgb green pt 7 lw 2 t "torus, r = 3 mm", \
     f("torus") u 1:4 w lp lc rgb green pt 8 dt 2 not, \
     [0.085:1] 1e3 * x**2 / (6 * 5) w l lc rgb grey dt 3 lw 2 t "h^2 / 6R, sphere"

set title "Distance, sharp edges"
set yrange [0.1:4000]
plot f("box") u 1:2 w lp lc rgb blue pt 7 lw 2 t "box", \
     f("box") u 1:4 w lp lc rgb blue pt 8 dt 2 not, \
     f("wedge") u 1:2 w lp lc rgb orange pt 7 lw 2 t "wedge, 30°", \
     f("wedge") u 1:4 w lp lc rgb orange pt 8 dt 2 not, \
     f("screw") u 1:2 w lp lc rgb green pt 7 lw 2 t "thread M12", \
     f("screw") u 1:4 w lp lc rgb green pt 8 dt 2 not, \
     [0.085:1] 1e3 * 0.43 * x w l lc rgb grey dt 3 lw 2 t "0.43 h, worst of a square edge", \
     [0.085:1] 10 * x**2 w l lc rgb grey dt 4 lw 1 t "∝ h^2, mean: edges fill less of the band"

set title "Normal, smooth surfaces"
set ylabel "error of the normal [degrees]"
set yrange [0.001:100]
set label 1 "○ continuous     × trilinear, mean"
plot f("sphere") u 1:5 w lp lc rgb blue pt 6 lw 2 t "sphere", \
     f("sphere") u 1:8 w lp lc rgb blue pt 2 dt 2 not, \
     f("cylinder") u 1:5 w lp lc rgb orange pt 6 lw 2 t "cylinder", \
     f("cylinder") u 1:8 w lp lc rgb orange pt 2 dt 2 not, \
     f("torus") u 1:5 w lp lc rgb green pt 6 lw 2 t "torus", \
     f("torus") u 1:8 w lp lc rgb green pt 2 dt 2 not, \
     [0.085:1] 4 * x w l lc rgb grey dt 3 lw 2 t "∝ h", \
     [0.085:1] 0.8 * x**2 w l lc rgb grey dt 4 lw 2 t "∝ h^2"

set title "Normal, sharp edges"
set yrange [0.01:1000]
plot f("box") u 1:5 w lp lc rgb blue pt 6 lw 2 t "box", \
     f("box") u 1:8 w lp lc rgb blue pt 2 dt 2 not, \
     f("wedge") u 1:5 w lp lc rgb orange pt 6 lw 2 t "wedge, 30°", \
     f("wedge") u 1:8 w lp lc rgb orange pt 2 dt 2 not, \
     f("screw") u 1:5 w lp lc rgb green pt 6 lw 2 t "thread M12", \
     f("screw") u 1:8 w lp lc rgb green pt 2 dt 2 not, \
     [0.085:1] 6 * x w l lc rgb grey dt 3 lw 2 t "∝ h"
unset multiplot

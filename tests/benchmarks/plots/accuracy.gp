# SPDX-License-Identifier: BSD-3-Clause
# gnuplot -e "data='FOLDER'; out='FOLDER'; plots='.../plots'" accuracy.gp: accuracy_smooth.png, accuracy_sharp.png
load plots."/style.gp"
set terminal pngcairo size 840,360 font "DejaVu Sans,9.5" background "white"
layout = "set multiplot layout 1,2 margins 0.08,0.985,0.16,0.92 spacing 0.1,0.1"
set format x "%g"
set xrange [0.085:1]
set xtics (0.1, 0.2, 0.4, 0.8)
set xlabel "voxel size h [mm]"
f(s) = data."/accuracy_".s.".dat"


set output out."/accuracy_smooth.png"
@layout
set label 1 "● mean     △ greatest" at graph 0.98,0.05 right tc rgb grey
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

set label 1 "mean:  ○ continuous   × trilinear" at graph 0.98,0.05 right tc rgb grey
set title "Normal, smooth surfaces"
set ylabel "error of the normal [degrees]"
set yrange [0.001:100]
plot f("sphere") u 1:5 w lp lc rgb blue pt 6 lw 2 t "sphere", \
     f("sphere") u 1:8 w lp lc rgb blue pt 2 dt 2 not, \
     f("cylinder") u 1:5 w lp lc rgb orange pt 6 lw 2 t "cylinder", \
     f("cylinder") u 1:8 w lp lc rgb orange pt 2 dt 2 not, \
     f("torus") u 1:5 w lp lc rgb green pt 6 lw 2 t "torus", \
     f("torus") u 1:8 w lp lc rgb green pt 2 dt 2 not, \
     [0.085:1] 4 * x w l lc rgb grey dt 3 lw 2 t "∝ h", \
     [0.085:1] 0.8 * x**2 w l lc rgb grey dt 4 lw 2 t "∝ h^2"
unset multiplot

set output out."/accuracy_sharp.png"
@layout
set label 1 "● mean     △ greatest" at graph 0.98,0.05 right tc rgb grey
set ylabel "error of the distance [µm]"
set title "Distance, sharp edges"
set yrange [0.1:4000]
plot f("box") u 1:2 w lp lc rgb blue pt 7 lw 2 t "box", \
     f("box") u 1:4 w lp lc rgb blue pt 8 dt 2 not, \
     f("wedge") u 1:2 w lp lc rgb orange pt 7 lw 2 t "wedge, 30°", \
     f("wedge") u 1:4 w lp lc rgb orange pt 8 dt 2 not, \
     f("screw") u 1:2 w lp lc rgb green pt 7 lw 2 t "thread M12", \
     f("screw") u 1:4 w lp lc rgb green pt 8 dt 2 not, \
     [0.085:1] 1e3 * 0.43 * x w l lc rgb grey dt 3 lw 2 t "0.43 h, a square edge at worst", \
     [0.085:1] 16 * x**2 w l lc rgb grey dt 4 lw 2 t "∝ h^2"

set label 1 "mean:  ○ continuous   × trilinear" at graph 0.98,0.05 right tc rgb grey
set ylabel "error of the normal [degrees]"
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

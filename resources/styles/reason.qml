<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology|Symbology3D" version="3.40.0" sync3DRendererTo2DRenderer="1">
  <renderer type="classified" attribute="Reason" pointSize="0.8" pointSizeUnit="MM" pointSizeMapUnitScale="3x:0,0,0,0,0,0" maximumScreenError="0.3" maximumScreenErrorUnit="MM" pointSymbol="1" drawOrder2d="1" renderAsTriangles="0" horizontalTriangleFilter="0" horizontalTriangleFilterThreshold="5" horizontalTriangleFilterUnit="MM">
    <categories>
      <category value="0" label="In no cluster: ground, or too low or too small to be considered" color="221,221,221,255" pointSize="0" render="true"/>
      <category value="1" label="Building: low entropy, typical of planes" color="0,68,136,255" pointSize="0" render="true"/>
      <category value="2" label="Building: low entropy, typical of planes, and impenetrable to the laser beam" color="0,68,136,255" pointSize="0" render="true"/>
      <category value="3" label="Building: moderate entropy, but the laser beam hardly penetrates it" color="102,153,204,255" pointSize="0" render="true"/>
      <category value="4" label="Building: connected to the roof above, below or beside it" color="170,200,230,255" pointSize="0" render="true"/>
      <category value="5" label="Building: low entropy, and adjacent to or surrounded by buildings, where points seen past an edge are no evidence of vegetation" color="51,119,187,255" pointSize="0" render="true"/>
      <category value="7" label="Building: planar over meters, like what surrounds it (matched images)" color="17,119,136,255" pointSize="0" render="true"/>
      <category value="8" label="Building: beside a building, and like the buildings of the scene" color="136,221,238,255" pointSize="0" render="true"/>
      <category value="11" label="Not a building: high entropy, typical of tree crowns" color="221,170,51,255" pointSize="0" render="true"/>
      <category value="12" label="Not a building: low entropy, but the laser beam penetrates it" color="153,119,0,255" pointSize="0" render="true"/>
      <category value="13" label="Not a building: the surface continues into the ground" color="170,136,119,255" pointSize="0" render="true"/>
      <category value="14" label="Not a building: smaller than the minimum building area, together with everything it touches" color="238,153,170,255" pointSize="0" render="true"/>
      <category value="16" label="Not a building: too close to the ground to belong to the roof at its location" color="153,68,85,255" pointSize="0" render="true"/>
      <category value="17" label="Not a building: too few of the points at roof height lie on surfaces, as in tree crowns" color="119,51,68,255" pointSize="0" render="true"/>
      <category value="18" label="Not a building: surrounded mostly by non-building points, like smooth spots of tree crowns" color="136,34,85,255" pointSize="0" render="true"/>
      <category value="19" label="Not a building: as green as the vegetation of the scene" color="102,119,34,255" pointSize="0" render="true"/>
      <category value="20" label="Not a building: as wide, long and high as a car, a van or a caravan (matched images)" color="170,68,153,255" pointSize="0" render="true"/>
      <category value="21" label="Undecided: all clusters have the same entropy" color="120,120,120,255" pointSize="0" render="true"/>
      <category value="22" label="Undecided: the points have no extent, so their entropy is undefined" color="80,80,80,255" pointSize="0" render="true"/>
      <category value="23" label="Not a building: unlike the other buildings of the scene" color="238,119,51,255" pointSize="0" render="true"/>
    </categories>
  </renderer>
  <blendMode>0</blendMode>
</qgis>
